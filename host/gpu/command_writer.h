#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gpu/device.h"

namespace coppice {

struct Kernel {
  const char* name;
  std::span<const std::uint32_t> spirv;
  std::span<const std::uint32_t> specialization;  // constants 0, 1, ...
};

// What tells pipelines apart.
struct PipelineKey {
  const std::uint32_t* kernel = nullptr;
  std::array<std::uint32_t, 8> constants{};
  std::size_t constant_count = 0;
  auto operator<=>(const PipelineKey&) const = default;
};

// Compiles the kernel's pipeline, if it is not yet there.
void prepare(Device& device, const Kernel& kernel);

// Where a block of a layout lies.
struct BlockMemory {
  VkBuffer buffer;
  VkDeviceSize offset;
};

// Records steps into a command buffer, whoever owns that. Allocates nothing for kernels that are prepared.
class CommandWriter {
 public:
  // The blocks must outlive it.
  CommandWriter(Device& device, VkCommandBuffer commands, std::span<const BlockMemory> blocks)
      : context_(device.context()), commands_(commands), blocks_(blocks) {}

  void dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                std::array<std::uint32_t, 3> groups);
  void dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push_constants, std::uint32_t block,
                         std::uint64_t offset);
  void clear(std::uint32_t block, std::uint64_t offset, std::uint64_t bytes);
  // What comes before it in the queue is done, and seen, when what comes behind it begins.
  void barrier();

  // Writes the time when all that was recorded so far is done.
  void stamp(VkQueryPool pool, std::uint32_t query);

 private:
  template <class Record>
  void step(const char* name, Record record);
  void bind(const Kernel& kernel, std::span<const std::byte> push_constants);

  VulkanContext& context_;
  VkCommandBuffer commands_;
  std::span<const BlockMemory> blocks_;
  PipelineKey bound_;  // of no kernel at first
};

}  // namespace coppice
