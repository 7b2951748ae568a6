#include "gpu/recorder.h"

#include <chrono>
#include <stdexcept>

#include "gpu/arena_blocks.h"
#include "interface/types.h"

namespace coppice {

namespace {

// Local size in x, from the kernel's execution mode: literal, or the id of a constant (LocalSizeId,
// SPIR-V 1.6) that may be a specialization constant. 0 for a kernel whose workgroup is one subgroup.
std::uint32_t local_size_x(const Kernel& kernel) {
  constexpr std::uint32_t op_execution_mode = 16, op_execution_mode_id = 331, op_constant = 43,
                          op_spec_constant = 50, op_decorate = 71;
  constexpr std::uint32_t mode_local_size = 17, mode_local_size_id = 38, decoration_spec_id = 1;
  const std::span<const std::uint32_t> spirv = kernel.spirv;
  std::uint32_t constant = 0, spec_id = 0;
  for (std::size_t i = 5; i < spirv.size(); i += spirv[i] >> 16) {
    const std::uint32_t op = spirv[i] & 0xffff;
    if (op == op_execution_mode && spirv[i + 2] == mode_local_size) return spirv[i + 3];
    if (op == op_execution_mode_id && spirv[i + 2] == mode_local_size_id) constant = spirv[i + 3];
    if (constant == 0) continue;
    if (op == op_decorate && spirv[i + 1] == constant && spirv[i + 2] == decoration_spec_id)
      spec_id = spirv[i + 3];
    if (op == op_constant && spirv[i + 2] == constant) return spirv[i + 3];
    if (op == op_spec_constant && spirv[i + 2] == constant)
      return spec_id < kernel.specialization.size() ? kernel.specialization[spec_id] : 0;
  }
  throw std::logic_error("kernel without a local size");
}

vk::raii::Pipeline make_pipeline(const VulkanContext& context, const Kernel& kernel) {
  const vk::raii::ShaderModule module(
      context.device, vk::ShaderModuleCreateInfo({}, kernel.spirv.size_bytes(), kernel.spirv.data()));
  std::vector<std::uint32_t> constants(kernel.specialization.begin(), kernel.specialization.end());
  std::vector<vk::SpecializationMapEntry> entries;
  for (std::uint32_t id = 0; id < constants.size(); ++id) entries.emplace_back(id, id * 4, 4);
  const auto add = [&](std::uint32_t id, std::uint32_t value) {
    entries.emplace_back(id, static_cast<std::uint32_t>(constants.size() * 4), 4);
    constants.push_back(value);
  };
  add(DEVICE_SUBGROUP_SIZE_ID, context.properties.subgroup_size);
  add(DEVICE_LANES_IN_STEP_ID, context.properties.lanes_in_step);
  const vk::SpecializationInfo specialization(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size() * 4, constants.data());
  // Kernels that rank by subgroup need whole ones; the others have no size that subgroups must divide.
  const bool whole = local_size_x(kernel) % context.properties.subgroup_size == 0;
  const auto flags = whole ? vk::PipelineShaderStageCreateFlagBits::eRequireFullSubgroups
                           : vk::PipelineShaderStageCreateFlags();
  // Without it a driver may take any of its sizes.
  const vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo size(context.properties.subgroup_size);
  const vk::PipelineShaderStageCreateInfo stage(
      flags, vk::ShaderStageFlagBits::eCompute, *module, "main", &specialization,
      whole && context.properties.has_subgroup_sizes ? &size : nullptr);
  return vk::raii::Pipeline(context.device, context.pipeline_cache,
                            vk::ComputePipelineCreateInfo({}, stage, *context.pipeline_layout));
}

vk::Pipeline pipeline_for(VulkanContext& context, const Kernel& kernel) {
  PipelineKey key{kernel.spirv.data(), {kernel.specialization.begin(), kernel.specialization.end()}};
  auto found = context.pipelines.find(key);
  if (found == context.pipelines.end()) {
    found = context.pipelines.emplace(std::move(key), make_pipeline(context, kernel)).first;
  }
  return *found->second;
}

}  // namespace

struct Recorder::Commands {
  Commands(VulkanContext& context, const Arena::Blocks& blocks) : context(context), blocks(blocks) {}

  VulkanContext& context;
  const Arena::Blocks& blocks;
  Timestamps timestamps;
  std::uint32_t query_limit = 0, query_count = 0;
  std::vector<std::uint32_t> mark_queries, step_queries;  // query after each mark and each step
  vk::raii::CommandBuffer buffer{nullptr};
  vk::raii::QueryPool queries{nullptr};
  vk::raii::Fence fence{nullptr};
  bool ended = false;

  std::uint32_t stamp() {
    if (query_count == query_limit) throw std::logic_error("recorder: more steps than announced");
    if (*queries) buffer.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *queries, query_count);
    return query_count++;
  }

  // All earlier steps before all later ones: kernels, clears and the words of indirect dispatches.
  void barrier() {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    const auto stages = Stage::eComputeShader | Stage::eAllTransfer;
    const vk::MemoryBarrier2 memory(stages, Access::eShaderStorageWrite | Access::eTransferWrite,
                                    stages | Stage::eDrawIndirect,
                                    Access::eShaderStorageRead | Access::eShaderStorageWrite |
                                        Access::eTransferWrite | Access::eIndirectCommandRead);
    buffer.pipelineBarrier2(vk::DependencyInfo({}, memory));
  }

  template <class Record>
  void step(const char* name, Record record) {
    if (ended) throw std::logic_error("recorder: already submitted");
    with_device_errors(context, [&] {
      if (context.labels) buffer.beginDebugUtilsLabelEXT(vk::DebugUtilsLabelEXT(name));
      barrier();
      record();
      if (context.labels) buffer.endDebugUtilsLabelEXT();
      if (timestamps == Timestamps::every_step) step_queries.push_back(stamp());
    });
  }

  void bind(const Kernel& kernel, std::span<const std::byte> push_constants) {
    buffer.bindPipeline(vk::PipelineBindPoint::eCompute, pipeline_for(context, kernel));
    buffer.pushConstants<std::byte>(
        *context.pipeline_layout, vk::ShaderStageFlagBits::eCompute, 0,
        {static_cast<std::uint32_t>(push_constants.size()), push_constants.data()});
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
    fence = vk::raii::Fence(context.device, vk::FenceCreateInfo());
    ended = true;
  }

  Times submit_and_wait(double limit_seconds);
};

Recorder::Recorder(Device& device, const Arena& arena, std::uint32_t step_limit, Timestamps timestamps)
    : commands_(std::make_unique<Commands>(device.context(), arena.blocks())) {
  Commands& c = *commands_;
  c.timestamps = timestamps;
  c.query_limit = 2 * step_limit + 2;
  with_device_errors(c.context, [&] {
    c.buffer = std::move(vk::raii::CommandBuffers(
                             c.context.device, {*c.context.command_pool, vk::CommandBufferLevel::ePrimary, 1})
                             .front());
    c.buffer.begin(vk::CommandBufferBeginInfo());
    if (c.context.properties.timestamp_period_ns > 0) {
      c.queries = vk::raii::QueryPool(c.context.device, {{}, vk::QueryType::eTimestamp, c.query_limit});
      c.buffer.resetQueryPool(*c.queries, 0, c.query_limit);
    }
    c.stamp();
  });
}

Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;

void Recorder::dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                        std::array<std::uint32_t, 3> groups) {
  commands_->step(kernel.name, [&] {
    commands_->bind(kernel, push_constants);
    commands_->buffer.dispatch(groups[0], groups[1], groups[2]);
  });
}

void Recorder::dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push_constants,
                                 std::uint32_t block, std::uint64_t offset) {
  commands_->step(kernel.name, [&] {
    commands_->bind(kernel, push_constants);
    commands_->buffer.dispatchIndirect(commands_->blocks.buffer(block), offset);
  });
}

void Recorder::clear(std::uint32_t block, std::uint64_t offset, std::uint64_t bytes) {
  commands_->step("clear",
                  [&] { commands_->buffer.fillBuffer(commands_->blocks.buffer(block), offset, bytes, 0); });
}

void Recorder::mark() { commands_->mark_queries.push_back(commands_->stamp()); }

Recorder::Times Recorder::submit_and_wait(double limit_seconds) {
  return with_device_errors(commands_->context, [&] { return commands_->submit_and_wait(limit_seconds); });
}

Recorder::Times Recorder::Commands::submit_and_wait(double limit_seconds) {
  Commands& c = *this;
  if (!c.ended) c.end();
  c.context.device.resetFences(*c.fence);
  const auto start = std::chrono::steady_clock::now();
  c.context.queue.submit(vk::SubmitInfo({}, {}, *c.buffer), *c.fence);
  wait_for(c.context, c.fence, limit_seconds);
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;

  Times times{wall.count(), wall.count(), {}, {}};
  if (!*c.queries) return times;
  const std::vector<std::uint64_t> ticks =
      c.queries
          .getResults<std::uint64_t>(0, c.query_count, c.query_count * 8, 8, vk::QueryResultFlagBits::e64)
          .second;
  const auto since = [&](std::uint32_t from, std::uint32_t to) {
    return static_cast<double>((ticks[to] - ticks[from]) & c.context.timestamp_mask) *
           c.context.properties.timestamp_period_ns * 1e-6;
  };
  times.total_ms = since(0, c.query_count - 1);
  for (const std::uint32_t query : c.mark_queries) times.marks_ms.push_back(since(0, query));
  for (const std::uint32_t query : c.step_queries) times.steps_ms.push_back(since(query - 1, query));
  return times;
}

}  // namespace coppice
