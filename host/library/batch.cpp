#include "pipeline/batch.h"

#include <algorithm>

#include "coppice/build.h"
#include "library/build_input.h"
#include "library/state.h"

namespace coppice {

struct BatchBuilder::Plan {
  struct Primitives {
    Layout layout = Layout::apart(~std::uint64_t{0});
    BatchPlan batch;
  };

  explicit Plan(Device& device) : device(device) {}

  Device& device;
  Primitives triangles, boxes;

  void cmd_build(VkCommandBuffer commands, const Primitives& plan, const ElementCount& primitive_count,
                 const BuildInput& input, VkDeviceAddress ranges, const ElementCount& range_count,
                 const MemoryRange& tree, const MemoryRange& scratch, KernelQueries* queries) const;
  BatchAddresses addresses(const Primitives& plan, const MemoryRange& tree) const;
};

BatchBuilder::BatchBuilder(const Context& context, std::uint32_t max_primitives, std::uint32_t max_trees,
                           const TreeOptions& options) {
  TreeOptions by_ploc = options;
  by_ploc.builder = DeviceBuilder::ploc;
  with_argument_errors([&] { check_build(max_primitives, to_build_options(by_ploc)); });
  const BuildOptions checked = context.state().checked(
      {.builds = false, .build = to_build_options(by_ploc), .inputs = true, .batches = true});
  plan_ = std::make_unique<Plan>(context.state().device());
  for (const PrimitiveKind kind : {PrimitiveKind::triangles, PrimitiveKind::boxes}) {
    Plan::Primitives& plan = kind == PrimitiveKind::triangles ? plan_->triangles : plan_->boxes;
    plan.batch = plan_batch(plan.layout, max_primitives, max_trees, checked, kind);
    prepare_chain(plan_->device, [&](Chain& chain) {
      if (kind == PrimitiveKind::triangles) {
        append_batch(chain, plan.batch, {VertexTriangles{}, {}});
      } else {
        append_batch(chain, plan.batch, {GivenBoxes{}, {}});
      }
    });
  }
}

BatchBuilder::~BatchBuilder() = default;
BatchBuilder::BatchBuilder(BatchBuilder&&) noexcept = default;

BuildSizes BatchBuilder::sizes() const {
  const auto most = [&](Memory memory) {
    return std::max(plan_->triangles.layout.bytes_of(memory), plan_->boxes.layout.bytes_of(memory));
  };
  return {most(Memory::tree), most(Memory::scratch), 0};
}

void BatchBuilder::Plan::cmd_build(VkCommandBuffer commands, const Primitives& plan,
                                   const ElementCount& primitive_count, const BuildInput& input,
                                   VkDeviceAddress ranges, const ElementCount& range_count,
                                   const MemoryRange& tree, const MemoryRange& scratch,
                                   KernelQueries* queries) const {
  check_count(primitive_count, plan.batch.primitives.count, "count");
  check_count(range_count, static_cast<std::uint32_t>(plan.batch.ranges.count), "range_count");
  CallMemory memory(device);
  memory.set(Memory::tree, tree, plan.layout.bytes_of(Memory::tree), "tree");
  memory.set(Memory::scratch, scratch, plan.layout.bytes_of(Memory::scratch), "scratch");
  memory.set(Memory::source, ranges, range_count.maximum, 8, "ranges");
  CommandSink sink(device, commands, plan.layout, memory, queries);
  Chain chain(memory.addresses(), &sink);
  BatchPlan batch = plan.batch;
  batch.primitives.count = primitive_count.maximum;
  batch.ranges.count = range_count.maximum;
  append_batch(chain, batch, input, {range_count.address});
}

BatchAddresses BatchBuilder::Plan::addresses(const Primitives& plan, const MemoryRange& tree) const {
  const VkDeviceAddress base = checked_address(device, tree, plan.layout.bytes_of(Memory::tree), "tree");
  const auto at = [&](const auto& slot) { return slot.count > 0 ? base + slot.place.offset : 0; };
  const BatchPlan& slots = plan.batch;
  return {at(slots.nodes), at(slots.trees), at(slots.primitives.triangles), at(slots.state),
          at(slots.primitives.state)};
}

void BatchBuilder::cmd_build(VkCommandBuffer commands, const TriangleInput& input, VkDeviceAddress ranges,
                             const ElementCount& range_count, const MemoryRange& tree,
                             const MemoryRange& scratch, KernelQueries* queries) const {
  plan_->cmd_build(commands, plan_->triangles, input.count, to_build_input(input), ranges, range_count, tree,
                   scratch, queries);
}

void BatchBuilder::cmd_build(VkCommandBuffer commands, const BoxInput& input, VkDeviceAddress ranges,
                             const ElementCount& range_count, const MemoryRange& tree,
                             const MemoryRange& scratch, KernelQueries* queries) const {
  plan_->cmd_build(commands, plan_->boxes, input.count, to_build_input(input), ranges, range_count, tree,
                   scratch, queries);
}

BatchAddresses BatchBuilder::triangle_trees(const MemoryRange& tree) const {
  return plan_->addresses(plan_->triangles, tree);
}

BatchAddresses BatchBuilder::box_trees(const MemoryRange& tree) const {
  return plan_->addresses(plan_->boxes, tree);
}

}  // namespace coppice
