#include "gpu/recorder.h"

#include <chrono>
#include <stdexcept>

#include "gpu/arena_blocks.h"

namespace coppice {

namespace {

vk::raii::CommandBuffer make_buffer_of_commands(VulkanContext& context) {
  return std::move(
      vk::raii::CommandBuffers(context.device, {*context.command_pool, vk::CommandBufferLevel::ePrimary, 1})
          .front());
}

}  // namespace

struct Recorder::Commands {
  Commands(Device& device, const Arena::Blocks& blocks)
      : context(device.context()),
        buffer(make_buffer_of_commands(context)),
        blocks(blocks.memory()),
        writer(device, *buffer, this->blocks) {}

  VulkanContext& context;
  vk::raii::CommandBuffer buffer;
  std::vector<BlockMemory> blocks;
  CommandWriter writer;
  Timestamps timestamps;
  std::uint32_t query_limit = 0, query_count = 0;
  std::vector<std::uint32_t> mark_queries, step_queries;  // query after each mark and each step
  vk::raii::QueryPool queries{nullptr};
  bool ended = false;
  std::uint64_t submitted = 0;  // its value of the timeline
  std::chrono::steady_clock::time_point submit_time;

  std::uint32_t stamp() {
    if (query_count == query_limit) throw std::logic_error("recorder: more steps than announced");
    if (*queries) writer.stamp(*queries, query_count);
    return query_count++;
  }

  void barrier() {
    if (ended) throw std::logic_error("recorder: already submitted");
    with_device_errors(context, [&] { writer.barrier(); });
  }

  template <class Record>
  void step(Record record) {
    if (ended) throw std::logic_error("recorder: already submitted");
    with_device_errors(context, [&] {
      record();
      if (timestamps == Timestamps::every_step) step_queries.push_back(stamp());
    });
  }

  void end() {
    using Stage = vk::PipelineStageFlagBits2;
    const vk::MemoryBarrier2 memory(
        Stage::eComputeShader | Stage::eAllTransfer,
        vk::AccessFlagBits2::eShaderStorageWrite | vk::AccessFlagBits2::eTransferWrite, Stage::eHost,
        vk::AccessFlagBits2::eHostRead | vk::AccessFlagBits2::eHostWrite);
    stamp();
    buffer.pipelineBarrier2(vk::DependencyInfo({}, memory));
    buffer.end();
    ended = true;
  }

  Times times(double wall_ms) const;
};

Recorder::Recorder(Device& device, const Arena& arena, std::uint32_t step_limit, Timestamps timestamps) {
  with_device_errors(device.context(), [&] {
    commands_ = std::make_unique<Commands>(device, arena.blocks());
    Commands& c = *commands_;
    c.timestamps = timestamps;
    c.query_limit = 2 * step_limit + 2;
    c.buffer.begin(vk::CommandBufferBeginInfo());
    if (c.context.properties.timestamp_period_ns > 0) {
      c.queries = vk::raii::QueryPool(c.context.device, {{}, vk::QueryType::eTimestamp, c.query_limit},
                                      c.context.allocator);
      c.buffer.resetQueryPool(*c.queries, 0, c.query_limit);
    }
    c.stamp();
  });
}

Recorder::~Recorder() {
  if (commands_) free_unless_hung(commands_->context, commands_);
}
Recorder::Recorder(Recorder&&) noexcept = default;

void Recorder::dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                        std::array<std::uint32_t, 3> groups) {
  commands_->step([&] { commands_->writer.dispatch(kernel, push_constants, groups); });
}

void Recorder::dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push_constants,
                                 std::uint32_t block, std::uint64_t offset) {
  commands_->step([&] { commands_->writer.dispatch_indirect(kernel, push_constants, block, offset); });
}

void Recorder::clear(std::uint32_t block, std::uint64_t offset, std::uint64_t bytes) {
  commands_->step([&] { commands_->writer.clear(block, offset, bytes); });
}

void Recorder::barrier() { commands_->barrier(); }

void Recorder::mark() { commands_->mark_queries.push_back(commands_->stamp()); }

std::uint64_t Recorder::submit() {
  Commands& c = *commands_;
  return with_device_errors(c.context, [&] {
    if (!c.ended) c.end();
    c.submit_time = std::chrono::steady_clock::now();
    return c.submitted = submit_commands(c.context, *c.buffer);
  });
}

Recorder::Times Recorder::wait(double limit_seconds) {
  Commands& c = *commands_;
  return with_device_errors(c.context, [&] {
    wait_for(c.context, c.submitted, limit_seconds);
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - c.submit_time;
    return c.times(wall.count());
  });
}

Recorder::Times Recorder::Commands::times(double wall_ms) const {
  Times times{wall_ms, wall_ms, {}, {}};
  if (!*queries) return times;
  const std::vector<std::uint64_t> ticks =
      queries.getResults<std::uint64_t>(0, query_count, query_count * 8, 8, vk::QueryResultFlagBits::e64)
          .second;
  const auto since = [&](std::uint32_t from, std::uint32_t to) {
    return static_cast<double>((ticks[to] - ticks[from]) & context.timestamp_mask) *
           context.properties.timestamp_period_ns * 1e-6;
  };
  times.total_ms = since(0, query_count - 1);
  for (const std::uint32_t query : mark_queries) times.marks_ms.push_back(since(0, query));
  for (const std::uint32_t query : step_queries) times.steps_ms.push_back(since(query - 1, query));
  return times;
}

}  // namespace coppice
