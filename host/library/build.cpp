#include "coppice/build.h"

#include <algorithm>
#include <optional>

#include "library/build_input.h"
#include "library/state.h"
#include "pipeline/primitives.h"
#include "pipeline/wide_plan.h"

namespace coppice {

// Trees over triangles and over boxes have different slots.
struct Builder::Plan {
  struct Primitives {
    Layout layout = Layout::apart(~std::uint64_t{0});
    BuildPlan build;
    std::optional<WidePlan> wide;
  };

  // Even of no primitives a tree has a place, which rays find empty.
  Plan(Device& device, std::uint32_t max_primitives, const BuildOptions& options, bool wide)
      : device(device) {
    const std::uint32_t most = std::max(max_primitives, 1u);
    triangles.build = plan_build(triangles.layout, most, options, PrimitiveKind::triangles);
    boxes.build = plan_build(boxes.layout, most, options, PrimitiveKind::boxes);
    // Rays of boxes find candidates in the binary tree only.
    if (wide)
      triangles.wide =
          plan_wide(triangles.layout, triangles.build, &triangles.build, device.properties().max_turns());
  }

  BuildSizes sizes() const {
    const auto most = [&](Memory memory) {
      return std::max(triangles.layout.bytes_of(memory), boxes.layout.bytes_of(memory));
    };
    return {most(Memory::tree), most(Memory::scratch), 0};
  }

  Device& device;
  Primitives triangles, boxes;

  void cmd_build(VkCommandBuffer commands, const Primitives& plan, const ElementCount& count,
                 const BuildInput& input, const MemoryRange& tree, const MemoryRange& scratch,
                 KernelQueries* queries) const;

  TreeAddresses addresses(const Primitives& plan, const MemoryRange& tree) const;
};

Builder::Builder(const Context& context, std::uint32_t max_primitives, const TreeOptions& options) {
  with_argument_errors([&] { check_build(max_primitives, to_build_options(options)); });
  const BuildOptions checked =
      context.state().checked({.build = to_build_options(options), .wide = options.wide, .inputs = true});
  plan_ = std::make_unique<Plan>(context.state().device(), max_primitives, checked, options.wide);
  // Numbers at which other kernels run, or others of their variants.
  for (const std::uint32_t count : {std::max(max_primitives, 1u), std::min(max_primitives, 1u << 18), 1u}) {
    prepare_chain(plan_->device, [&](Chain& chain) {
      append_build(chain, with_count(plan_->triangles.build, count), {VertexTriangles{}, {}});
      append_build(chain, with_count(plan_->boxes.build, count), {GivenBoxes{}, {}});
      if (plan_->triangles.wide)
        append_wide(chain, plan_->triangles.build, with_count(*plan_->triangles.wide, count));
    });
  }
}

Builder::~Builder() = default;
Builder::Builder(Builder&&) noexcept = default;

BuildSizes Builder::sizes() const { return plan_->sizes(); }

BuildSizes build_sizes(const Context& context, std::uint32_t max_primitives, const TreeOptions& options) {
  BuildOptions build = to_build_options(options);
  with_argument_errors([&] { check_build(max_primitives, build); });
  build.variants = context.state().variants();
  BuildSizes most;
  for (const bool lookback : {false, true}) {  // what a check would allow is not known
    build.lookback = lookback;
    const BuildSizes sizes =
        Builder::Plan(context.state().device(), max_primitives, build, options.wide).sizes();
    most.tree_bytes = std::max(most.tree_bytes, sizes.tree_bytes);
    most.scratch_bytes = std::max(most.scratch_bytes, sizes.scratch_bytes);
  }
  return most;
}

TreeAddresses Builder::Plan::addresses(const Primitives& plan, const MemoryRange& tree) const {
  const VkDeviceAddress base = checked_address(device, tree, plan.layout.bytes_of(Memory::tree), "tree");
  const auto at = [&](const auto& slot) { return slot.count > 0 ? base + slot.place.offset : 0; };
  const TreeSlots& slots = plan.build;
  return {at(slots.nodes), at(slots.state), at(slots.triangles), at(slots.wide_nodes), at(slots.wide_counts)};
}

void Builder::Plan::cmd_build(VkCommandBuffer commands, const Primitives& plan, const ElementCount& count,
                              const BuildInput& input, const MemoryRange& tree, const MemoryRange& scratch,
                              KernelQueries* queries) const {
  check_count(count, plan.build.triangle_count, "count");
  CallMemory memory(device);
  memory.set(Memory::tree, tree, plan.layout.bytes_of(Memory::tree), "tree");
  memory.set(Memory::scratch, scratch, plan.layout.bytes_of(Memory::scratch), "scratch");
  CommandSink sink(device, commands, plan.layout, memory, queries);
  Chain chain(memory.addresses(), &sink);
  const BuildPlan build = with_count(plan.build, count.maximum);
  append_build(chain, build, input);
  if (plan.wide) append_wide(chain, build, with_count(*plan.wide, count.maximum));
}

void Builder::cmd_build(VkCommandBuffer commands, const TriangleInput& input, const MemoryRange& tree,
                        const MemoryRange& scratch, KernelQueries* queries) const {
  plan_->cmd_build(commands, plan_->triangles, input.count, to_build_input(input), tree, scratch, queries);
}

void Builder::cmd_build(VkCommandBuffer commands, const BoxInput& input, const MemoryRange& tree,
                        const MemoryRange& scratch, KernelQueries* queries) const {
  plan_->cmd_build(commands, plan_->boxes, input.count, to_build_input(input), tree, scratch, queries);
}

TreeAddresses Builder::triangle_tree(const MemoryRange& tree) const {
  return plan_->addresses(plan_->triangles, tree);
}

TreeAddresses Builder::box_tree(const MemoryRange& tree) const {
  return plan_->addresses(plan_->boxes, tree);
}

}  // namespace coppice
