#pragma once

// All that its templates leave in a library bears our name, so that a program may have a vulkan.hpp of its
// own.
#define VULKAN_HPP_NAMESPACE coppice_vk
// Found by hand: a caller may bring vkGetInstanceProcAddr.
#define VULKAN_HPP_ENABLE_DYNAMIC_LOADER_TOOL 0

#include <array>
#include <compare>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "gpu/command_writer.h"
#include "gpu/device.h"

namespace coppice {

namespace vk = coppice_vk;

// The system's vkGetInstanceProcAddr; throws DeviceError where there is no loader.
PFN_vkGetInstanceProcAddr loader_entry();

// The Vulkan objects behind a Device. Members are destroyed in reverse order.
struct VulkanContext {
  explicit VulkanContext(PFN_vkGetInstanceProcAddr entry) : loader(entry) {}
  ~VulkanContext();

  DeviceProperties properties;
  std::mutex message_mutex;
  std::vector<std::string> messages;
  Log log;

  vk::raii::Context loader;
  vk::raii::Instance instance{nullptr};
  vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
  vk::raii::PhysicalDevice physical{nullptr};
  vk::raii::Device device{nullptr};
  vk::raii::Queue queue{nullptr};
  std::uint32_t queue_family = 0;
  const vk::AllocationCallbacks* allocator = nullptr;
  bool adopted = false;              // instance, device and queue are the caller's
  bool adopted_cache = false;        // so is the pipeline cache
  std::uint64_t timestamp_mask = 0;  // the bits that count
  vk::raii::CommandPool command_pool{nullptr};
  vk::raii::Semaphore timeline{nullptr};  // of submits
  std::uint64_t submitted = 0;            // its value when all of them are done
  bool hung = false;                      // something is under way for good: nothing is freed any more
  vk::raii::PipelineLayout pipeline_layout{nullptr};  // 128 bytes of push constants, no descriptors
  vk::raii::PipelineCache pipeline_cache{nullptr};    // none where nothing is kept
  std::filesystem::path pipeline_file;
  std::vector<std::uint8_t> kept_pipelines;  // what the file held; empty: nothing of use
  std::shared_mutex pipeline_mutex;          // of `pipelines`
  std::mutex compile_mutex;                  // one kernel at a time, while others record
  std::map<PipelineKey, vk::raii::Pipeline> pipelines;
  bool labels = false;  // debug labels can be recorded
  bool like_a_gpu = false;
  bool timestamps = true;  // if the device has them

  // Index of a memory type among `allowed` with all of `flags`; throws DeviceError if there is none.
  std::uint32_t memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags flags) const;
};

// Calls `action`; what Vulkan throws becomes a DeviceError that names the device, a DeviceLost where it is
// gone.
template <class Action>
auto with_device_errors(const VulkanContext& context, Action action) {
  try {
    return action();
  } catch (const vk::DeviceLostError&) {
    throw DeviceLost(context.properties.name + ": the device was lost");
  } catch (const vk::SystemError& error) {
    throw DeviceError(context.properties.name + ": " + error.what());
  }
}

// Submits the commands; returns the value of the timeline when they are done.
std::uint64_t submit_commands(VulkanContext& context, vk::CommandBuffer commands);

// Throws DeviceHung after `limit_seconds`.
void wait_for(VulkanContext& context, std::uint64_t value, double limit_seconds);

// Frees what the device may still work with, unless it hangs: then it is left alone for good.
template <class Owned>
void free_unless_hung(const VulkanContext& context, Owned& owned) {
  if (context.hung) (void)owned.release();
}

}  // namespace coppice
