#pragma once

#include "gpu/arena.h"
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

  vk::Buffer buffer(std::uint32_t block) const { return *list.at(block).buffer; }
};

// Records copies with `record` and waits until the device has done them. They see all earlier submits, and
// what comes later, the host included, sees them.
template <class Record>
void run_commands(VulkanContext& context, Record record);

// Waits for the fence. After `limit_seconds` the program ends with status 1 and one line.
void wait_for(const VulkanContext& context, const vk::raii::Fence& fence, double limit_seconds);

template <class Record>
void run_commands(VulkanContext& context, Record record) {
  with_device_errors(context, [&] {
    auto commands = std::move(
        vk::raii::CommandBuffers(context.device, {*context.command_pool, vk::CommandBufferLevel::ePrimary, 1})
            .front());
    commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    const vk::MemoryBarrier2 before(Stage::eAllCommands, Access::eMemoryWrite, Stage::eAllTransfer,
                                    Access::eTransferRead | Access::eTransferWrite);
    commands.pipelineBarrier2(vk::DependencyInfo({}, before));
    record(commands);
    const vk::MemoryBarrier2 after(Stage::eAllTransfer, Access::eTransferWrite,
                                   Stage::eHost | Stage::eAllCommands,
                                   Access::eHostRead | Access::eMemoryRead | Access::eMemoryWrite);
    commands.pipelineBarrier2(vk::DependencyInfo({}, after));
    commands.end();
    const vk::raii::Fence fence(context.device, vk::FenceCreateInfo());
    context.queue.submit(vk::SubmitInfo({}, {}, *commands), *fence);
    wait_for(context, fence, 60);
  });
}

}  // namespace coppice
