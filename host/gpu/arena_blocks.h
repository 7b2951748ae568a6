#pragma once

#include "gpu/arena.h"
#include "gpu/vulkan_context.h"

namespace coppice {

struct Buffer {
  vk::raii::DeviceMemory memory{nullptr};
  vk::raii::Buffer buffer{nullptr};
  std::byte* mapped = nullptr;  // null where the host cannot see it
  std::uint64_t address = 0;
};

struct Arena::Blocks {
  VulkanContext* context;
  std::vector<Buffer> list;
  Buffer staging;  // only where blocks are not mapped

  vk::Buffer buffer(std::uint32_t block) const { return *list.at(block).buffer; }
};

// Records with `record` and waits until the device has done it.
template <class Record>
void run_commands(VulkanContext& context, Record record);

// Waits for the fence; throws DeviceError after `limit_seconds`.
void wait_for(const VulkanContext& context, const vk::raii::Fence& fence, double limit_seconds);

template <class Record>
void run_commands(VulkanContext& context, Record record) {
  auto commands = std::move(
      vk::raii::CommandBuffers(context.device, {*context.command_pool, vk::CommandBufferLevel::ePrimary, 1})
          .front());
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  commands.end();
  const vk::raii::Fence fence(context.device, vk::FenceCreateInfo());
  context.queue.submit(vk::SubmitInfo({}, {}, *commands), *fence);
  wait_for(context, fence, 60);
}

}  // namespace coppice
