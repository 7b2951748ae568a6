#pragma once

#include "gpu/arena.h"
#include "gpu/command_writer.h"
#include "gpu/vulkan_context.h"

namespace coppice {

struct Buffer {
  vk::raii::DeviceMemory memory{nullptr};
  vk::raii::Buffer buffer{nullptr};
  std::byte* mapped = nullptr;  // null where the host cannot see it
  std::uint64_t bytes = 0;
  std::uint64_t address = 0;
};

struct Arena::Blocks {
  VulkanContext* context;
  std::vector<Buffer> list;
  Buffer staging;  // only where blocks are not mapped

  std::vector<BlockMemory> memory() const {
    std::vector<BlockMemory> blocks;
    for (const Buffer& block : list) blocks.push_back({*block.buffer, 0});
    return blocks;
  }
};

// Records copies with `record` and waits until the device has done them. They see all earlier submits, and
// what comes later, the host included, sees them.
template <class Record>
void run_commands(VulkanContext& context, Record record) {
  with_device_errors(context, [&] {
    auto commands = std::make_unique<vk::raii::CommandBuffers>(
        context.device,
        vk::CommandBufferAllocateInfo(*context.command_pool, vk::CommandBufferLevel::ePrimary, 1));
    const vk::raii::CommandBuffer& buffer = commands->front();
    buffer.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    const vk::MemoryBarrier2 before(Stage::eAllCommands, Access::eMemoryWrite, Stage::eAllTransfer,
                                    Access::eTransferRead | Access::eTransferWrite);
    buffer.pipelineBarrier2(vk::DependencyInfo({}, before));
    record(buffer);
    const vk::MemoryBarrier2 after(Stage::eAllTransfer, Access::eTransferWrite,
                                   Stage::eHost | Stage::eAllCommands,
                                   Access::eHostRead | Access::eMemoryRead | Access::eMemoryWrite);
    buffer.pipelineBarrier2(vk::DependencyInfo({}, after));
    buffer.end();
    try {
      wait_for(context, submit_commands(context, *buffer), 60);
    } catch (const DeviceHung&) {
      (void)commands.release();
      throw;
    }
  });
}

}  // namespace coppice
