#include <cstdio>

#include "gpu/vulkan_context.h"

namespace coppice {

std::uint64_t submit_commands(VulkanContext& context, vk::CommandBuffer commands) {
  if (!*context.queue) throw DeviceError(context.properties.name + ": no queue to submit to");
  const vk::CommandBufferSubmitInfo buffer(commands);
  const vk::SemaphoreSubmitInfo done(*context.timeline, context.submitted + 1,
                                     vk::PipelineStageFlagBits2::eAllCommands);
  context.queue.submit2(vk::SubmitInfo2({}, {}, buffer, done));
  return ++context.submitted;
}

void wait_for(VulkanContext& context, std::uint64_t value, double limit_seconds) {
  const auto limit_ns = static_cast<std::uint64_t>(limit_seconds * 1e9);
  const vk::SemaphoreWaitInfo wait({}, *context.timeline, value);
  if (context.device.waitSemaphores(wait, limit_ns) != vk::Result::eTimeout) {
    // The validation layer notes the end of submits in a thread of its own, with a lock that a process which
    // is forked meanwhile would find taken for ever. This waits for that thread.
    if (*context.messenger && !context.adopted) context.queue.waitIdle();
    return;
  }
  context.hung = true;
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%g", limit_seconds);
  throw DeviceHung(context.properties.name + " did not finish within " + seconds + " s");
}

}  // namespace coppice
