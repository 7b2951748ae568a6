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

    std::uint64_t bytes(Memory memory) const {
      return layout.block_bytes()[static_cast<std::size_t>(memory)];
    }
  };

  explicit Plan(Device& device) : device(device) {}

  Device& device;
  Primitives triangles, boxes;

  void cmd_build(VkCommandBuffer commands, const Primitives& plan, const ElementCount& count,
                 const BuildInput& input, const MemoryRange& tree, const MemoryRange& scratch,
                 KernelQueries* queries) const;

  TreeAddresses addresses(const Primitives& plan, const MemoryRange& tree) const;
};

Builder::Builder(const Context& context, std::uint32_t max_primitives, const TreeOptions& options) {
  with_argument_errors([&] { check_build(max_primitives, to_build_options(options)); });
  const BuildOptions checked = context.state().checked(to_build_options(options));
  plan_ = std::make_unique<Plan>(context.state().device());
  for (const PrimitiveKind kind : {PrimitiveKind::triangles, PrimitiveKind::boxes}) {
    Plan::Primitives& plan = kind == PrimitiveKind::triangles ? plan_->triangles : plan_->boxes;
    plan.build = plan_build(plan.layout, max_primitives, checked, kind);
    // Rays of boxes find candidates in the binary tree only.
    if (options.wide && kind == PrimitiveKind::triangles)
      plan.wide = plan_wide(plan.layout, plan.build, &plan.build);
  }
  // Numbers at which other kernels run, or others of their variants.
  for (const std::uint32_t count :
       {max_primitives, std::min(max_primitives, 1u << 18), std::min(max_primitives, 1u)}) {
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

BuildSizes Builder::sizes() const {
  const auto most = [&](Memory memory) {
    return std::max(plan_->triangles.bytes(memory), plan_->boxes.bytes(memory));
  };
  return {most(Memory::tree), most(Memory::scratch), 0};
}

TreeAddresses Builder::Plan::addresses(const Primitives& plan, const MemoryRange& tree) const {
  const VkDeviceAddress base = checked_address(device, tree, plan.bytes(Memory::tree), "tree");
  const auto at = [&](const auto& slot) { return slot.count > 0 ? base + slot.place.offset : 0; };
  const TreeSlots& slots = plan.build;
  return {at(slots.nodes), at(slots.state), at(slots.triangles), at(slots.wide_nodes), at(slots.wide_counts)};
}

void Builder::Plan::cmd_build(VkCommandBuffer commands, const Primitives& plan, const ElementCount& count,
                              const BuildInput& input, const MemoryRange& tree, const MemoryRange& scratch,
                              KernelQueries* queries) const {
  check_count(count, plan.build.triangle_count, "count");
  CallMemory memory(device);
  memory.set(Memory::tree, tree, plan.bytes(Memory::tree), "tree");
  memory.set(Memory::scratch, scratch, plan.bytes(Memory::scratch), "scratch");
  CommandSink sink(device, commands, memory, queries);
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
