#include "gpu/command_writer.h"

#include <algorithm>
#include <stdexcept>

#include "gpu/vulkan_context.h"
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
      context.device, vk::ShaderModuleCreateInfo({}, kernel.spirv.size_bytes(), kernel.spirv.data()),
      context.allocator);
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
                            vk::ComputePipelineCreateInfo({}, stage, *context.pipeline_layout),
                            context.allocator);
}

PipelineKey key_of(const Kernel& kernel) {
  PipelineKey key{kernel.spirv.data(), {}, kernel.specialization.size()};
  if (kernel.specialization.size() > key.constants.size())
    throw std::logic_error("kernel with too many constants");
  std::ranges::copy(kernel.specialization, key.constants.begin());
  return key;
}

vk::Pipeline pipeline_for(VulkanContext& context, const Kernel& kernel, const PipelineKey& key) {
  const auto find = [&]() -> vk::Pipeline {
    const std::shared_lock lock(context.pipeline_mutex);
    const auto found = context.pipelines.find(key);
    return found == context.pipelines.end() ? vk::Pipeline() : *found->second;
  };
  if (const vk::Pipeline pipeline = find()) return pipeline;
  const std::lock_guard compiling(context.compile_mutex);
  if (const vk::Pipeline pipeline = find()) return pipeline;
  vk::raii::Pipeline made = with_device_errors(context, [&] { return make_pipeline(context, kernel); });
  const std::unique_lock lock(context.pipeline_mutex);
  return *context.pipelines.emplace(key, std::move(made)).first->second;
}

}  // namespace

void prepare(Device& device, const Kernel& kernel) { pipeline_for(device.context(), kernel, key_of(kernel)); }

// Of kernels, clears and the words of indirect dispatches.
void CommandWriter::barrier() {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  const auto stages = Stage::eComputeShader | Stage::eAllTransfer;
  const vk::MemoryBarrier2 memory(stages, Access::eShaderStorageWrite | Access::eTransferWrite,
                                  stages | Stage::eDrawIndirect,
                                  Access::eShaderStorageRead | Access::eShaderStorageWrite |
                                      Access::eTransferWrite | Access::eIndirectCommandRead);
  vk::CommandBuffer(commands_).pipelineBarrier2(vk::DependencyInfo({}, memory),
                                                *context_.device.getDispatcher());
}

template <class Record>
void CommandWriter::step(const char* name, Record record) {
  const auto& functions = *context_.device.getDispatcher();
  const vk::CommandBuffer commands(commands_);
  if (context_.labels) commands.beginDebugUtilsLabelEXT(vk::DebugUtilsLabelEXT(name), functions);
  record(commands, functions);
  if (context_.labels) commands.endDebugUtilsLabelEXT(functions);
}

void CommandWriter::bind(const Kernel& kernel, std::span<const std::byte> push_constants) {
  const auto& functions = *context_.device.getDispatcher();
  const vk::CommandBuffer commands(commands_);
  if (const PipelineKey key = key_of(kernel); key != bound_) {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, pipeline_for(context_, kernel, key), functions);
    bound_ = key;
  }
  commands.pushConstants(*context_.pipeline_layout, vk::ShaderStageFlagBits::eCompute, 0,
                         static_cast<std::uint32_t>(push_constants.size()), push_constants.data(), functions);
}

void CommandWriter::dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                             std::array<std::uint32_t, 3> groups) {
  step(kernel.name, [&](vk::CommandBuffer commands, const auto& functions) {
    bind(kernel, push_constants);
    commands.dispatch(groups[0], groups[1], groups[2], functions);
  });
}

void CommandWriter::dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push_constants,
                                      std::uint32_t block, std::uint64_t offset) {
  step(kernel.name, [&](vk::CommandBuffer commands, const auto& functions) {
    bind(kernel, push_constants);
    commands.dispatchIndirect(blocks_[block].buffer, blocks_[block].offset + offset, functions);
  });
}

void CommandWriter::clear(std::uint32_t block, std::uint64_t offset, std::uint64_t bytes) {
  step("clear", [&](vk::CommandBuffer commands, const auto& functions) {
    commands.fillBuffer(blocks_[block].buffer, blocks_[block].offset + offset, bytes, 0, functions);
  });
}

void CommandWriter::stamp(VkQueryPool pool, std::uint32_t query) {
  vk::CommandBuffer(commands_).writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, pool, query,
                                               *context_.device.getDispatcher());
}

}  // namespace coppice
