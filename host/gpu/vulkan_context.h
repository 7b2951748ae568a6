#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "gpu/device.h"

namespace coppice {

struct PipelineKey {
  const std::uint32_t* kernel;
  std::vector<std::uint32_t> specialization;
  auto operator<=>(const PipelineKey&) const = default;
};

// The Vulkan objects behind a Device. Members are destroyed in reverse order.
struct VulkanContext {
  DeviceProperties properties;
  std::mutex message_mutex;
  std::vector<std::string> messages;

  vk::raii::Context loader;
  vk::raii::Instance instance{nullptr};
  vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
  vk::raii::PhysicalDevice physical{nullptr};
  vk::raii::Device device{nullptr};
  vk::raii::Queue queue{nullptr};
  std::uint32_t queue_family = 0;
  std::uint64_t timestamp_mask = 0;  // the bits that count
  vk::raii::CommandPool command_pool{nullptr};
  vk::raii::PipelineLayout pipeline_layout{nullptr};  // 128 bytes of push constants, no descriptors
  vk::raii::PipelineCache pipeline_cache{nullptr};    // none where nothing is kept
  std::filesystem::path pipeline_file;
  std::vector<std::uint8_t> kept_pipelines;  // what the file held; empty: nothing of use
  std::map<PipelineKey, vk::raii::Pipeline> pipelines;
  bool labels = false;  // debug labels can be recorded
  bool like_a_gpu = false;
  bool timestamps = true;  // if the device has them

  // Index of a memory type among `allowed` with all of `flags`; throws DeviceError if there is none.
  std::uint32_t memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags flags) const;
};

// Calls `action`; what Vulkan throws becomes a DeviceError that names the device.
template <class Action>
auto with_device_errors(const VulkanContext& context, Action action) {
  try {
    return action();
  } catch (const vk::SystemError& error) {
    throw DeviceError(context.properties.name + ": " + error.what());
  }
}

}  // namespace coppice
