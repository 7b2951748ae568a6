#include "coppice/build.h"

#include <algorithm>
#include <optional>

#include "library/build_input.h"
#include "library/state.h"
#include "pipeline/primitives.h"
#include "pipeline/refit.h"
#include "pipeline/wide_plan.h"

namespace coppice {

// Trees over triangles and over boxes have different slots.
struct Builder::Plan {
  struct Primitives {
    Layout layout = Layout::apart(~std::uint64_t{0});
    BuildPlan build;
    std::optional<WidePlan> wide;
    std::optional<RefitPlan> refit;
  };

  // Even of no primitives a tree has a place, which rays find empty.
  Plan(Device& device, std::uint32_t max_primitives, const BuildOptions& options, bool wide, bool refits)
      : device(device) {
    const std::uint32_t most = std::max(max_primitives, 1u);
    triangles.build = plan_build(triangles.layout, most, options, PrimitiveKind::triangles);
    boxes.build = plan_build(boxes.layout, most, options, PrimitiveKind::boxes);
    // Rays of boxes find candidates in the binary tree only.
    const std::uint32_t max_turns = device.properties().max_turns();
    if (wide)
      triangles.wide = plan_wide(triangles.layout, triangles.build, &triangles.build, max_turns, refits);
    if (refits)
      triangles.refit = plan_refit(triangles.layout, triangles.build, &triangles.build, max_turns, true);
  }

  BuildSizes sizes() const {
    const auto most = [&](Memory memory) {
      return std::max(triangles.layout.bytes_of(memory), boxes.layout.bytes_of(memory));
    };
    return {most(Memory::tree), most(Memory::scratch), most(Memory::update)};
  }

  Device& device;
  Primitives triangles, boxes;

  void cmd_build(VkCommandBuffer commands, const Primitives& plan, const ElementCount& count,
                 const BuildInput& input, const MemoryRange& tree, const MemoryRange& scratch,
                 const MemoryRange* update, KernelQueries* queries) const;

  // Of a call that updates a tree of so many triangles: calls `append(chain, build, wide, refit)`.
  template <class Append>
  void cmd_update(VkCommandBuffer commands, std::uint32_t count, const MemoryRange& tree,
                  const MemoryRange& update, KernelQueries* queries, Append append) const;

  TreeAddresses addresses(const Primitives& plan, const MemoryRange& tree) const;

  void require_refits() const {
    if (!triangles.refit) throw ArgumentError("refits: the builder was made without them");
  }
};

Builder::Builder(const Context& context, std::uint32_t max_primitives, const TreeOptions& options) {
  with_argument_errors([&] { check_build(max_primitives, to_build_options(options)); });
  const BuildOptions checked = context.state().checked(
      {.build = to_build_options(options), .wide = options.wide, .refits = options.refits, .inputs = true});
  plan_ =
      std::make_unique<Plan>(context.state().device(), max_primitives, checked, options.wide, options.refits);
  // Numbers at which other kernels run, or others of their variants.
  for (const std::uint32_t count : {std::max(max_primitives, 1u), std::min(max_primitives, 1u << 18), 1u}) {
    prepare_chain(plan_->device, [&](Chain& chain) {
      append_build(chain, with_count(plan_->triangles.build, count), {VertexTriangles{}, {}});
      append_build(chain, with_count(plan_->boxes.build, count), {GivenBoxes{}, {}});
      if (plan_->triangles.wide)
        append_wide(chain, plan_->triangles.build, with_count(*plan_->triangles.wide, count));
    });
  }
  if (!options.refits) return;
  for (const std::uint32_t count :
       {std::max(max_primitives, 1u), std::min(std::max(max_primitives, 1u), 2u)}) {
    prepare_chain(plan_->device, [&](Chain& chain) {
      const BuildPlan build = with_count(plan_->triangles.build, count);
      const RefitPlan refit = with_count(*plan_->triangles.refit, count);
      append_refit_order(chain, build, refit);
      append_refit(chain, build, refit);
      append_tree_cost(chain, build, refit);
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
        Builder::Plan(context.state().device(), max_primitives, build, options.wide, options.refits).sizes();
    most.tree_bytes = std::max(most.tree_bytes, sizes.tree_bytes);
    most.scratch_bytes = std::max(most.scratch_bytes, sizes.scratch_bytes);
    most.update_bytes = std::max(most.update_bytes, sizes.update_bytes);
  }
  return most;
}

TreeAddresses Builder::Plan::addresses(const Primitives& plan, const MemoryRange& tree) const {
  const VkDeviceAddress base = checked_address(device, tree, plan.layout.bytes_of(Memory::tree), "tree");
  const auto at = [&](const auto& slot) { return slot.count > 0 ? base + slot.place.offset : 0; };
  const TreeSlots& slots = plan.build;
  return {at(slots.nodes),      at(slots.state),       at(slots.triangles),
          at(slots.wide_nodes), at(slots.wide_counts), plan.refit ? at(plan.refit->state) : 0};
}

void Builder::Plan::cmd_build(VkCommandBuffer commands, const Primitives& plan, const ElementCount& count,
                              const BuildInput& input, const MemoryRange& tree, const MemoryRange& scratch,
                              const MemoryRange* update, KernelQueries* queries) const {
  check_count(count, plan.build.triangle_count, "count");
  CallMemory memory(device);
  memory.set(Memory::tree, tree, plan.layout.bytes_of(Memory::tree), "tree");
  memory.set(Memory::scratch, scratch, plan.layout.bytes_of(Memory::scratch), "scratch");
  if (update) memory.set(Memory::update, *update, plan.layout.bytes_of(Memory::update), "update");
  CommandSink sink(device, commands, plan.layout, memory, queries);
  Chain chain(memory.addresses(), &sink);
  const BuildPlan build = with_count(plan.build, count.maximum);
  append_build(chain, build, input);
  if (plan.wide) {
    const bool keeps = update || !plan.refit;
    append_wide(chain, build,
                with_count(keeps ? *plan.wide : without_update(*plan.wide, plan.build), count.maximum));
  }
  if (update) append_refit_order(chain, build, with_count(*plan.refit, count.maximum));
}

template <class Append>
void Builder::Plan::cmd_update(VkCommandBuffer commands, std::uint32_t count, const MemoryRange& tree,
                               const MemoryRange& update, KernelQueries* queries, Append append) const {
  require_refits();
  check_count({count}, triangles.build.triangle_count, "count");
  CallMemory memory(device);
  memory.set(Memory::tree, tree, triangles.layout.bytes_of(Memory::tree), "tree");
  memory.set(Memory::update, update, triangles.layout.bytes_of(Memory::update), "update");
  CommandSink sink(device, commands, triangles.layout, memory, queries);
  Chain chain(memory.addresses(), &sink);
  append(chain, with_count(triangles.build, count), with_count(*triangles.refit, count));
}

void Builder::cmd_build(VkCommandBuffer commands, const TriangleInput& input, const MemoryRange& tree,
                        const MemoryRange& scratch, KernelQueries* queries) const {
  plan_->cmd_build(commands, plan_->triangles, input.count, to_build_input(input), tree, scratch, nullptr,
                   queries);
}

void Builder::cmd_build(VkCommandBuffer commands, const TriangleInput& input, const MemoryRange& tree,
                        const MemoryRange& scratch, const MemoryRange& update, KernelQueries* queries) const {
  plan_->require_refits();
  plan_->cmd_build(commands, plan_->triangles, input.count, to_build_input(input), tree, scratch, &update,
                   queries);
}

void Builder::cmd_refit(VkCommandBuffer commands, const TriangleInput& input, const MemoryRange& tree,
                        const MemoryRange& update, KernelQueries* queries) const {
  check_address(input.count.address, 4, true, "count");
  const BuildInput given = to_build_input(input);
  plan_->cmd_update(commands, input.count.maximum, tree, update, queries,
                    [&](Chain& chain, const BuildPlan& build, const RefitPlan& refit) {
                      append_triangles(chain, {build.triangles.place, build.triangle_count},
                                       std::get<VertexTriangles>(given.primitives), given.count_at);
                      append_refit(chain, build, refit);
                      if (plan_->triangles.wide)
                        append_wide_boxes(chain, build,
                                          with_count(*plan_->triangles.wide, build.triangle_count));
                    });
}

void Builder::cmd_tree_cost(VkCommandBuffer commands, std::uint32_t maximum, const MemoryRange& tree,
                            const MemoryRange& update, KernelQueries* queries) const {
  plan_->cmd_update(commands, maximum, tree, update, queries,
                    [](Chain& chain, const BuildPlan& build, const RefitPlan& refit) {
                      append_tree_cost(chain, build, refit);
                    });
}

void Builder::cmd_build(VkCommandBuffer commands, const BoxInput& input, const MemoryRange& tree,
                        const MemoryRange& scratch, KernelQueries* queries) const {
  plan_->cmd_build(commands, plan_->boxes, input.count, to_build_input(input), tree, scratch, nullptr,
                   queries);
}

TreeAddresses Builder::triangle_tree(const MemoryRange& tree) const {
  return plan_->addresses(plan_->triangles, tree);
}

TreeAddresses Builder::box_tree(const MemoryRange& tree) const {
  return plan_->addresses(plan_->boxes, tree);
}

}  // namespace coppice
