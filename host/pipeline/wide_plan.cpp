#include "pipeline/wide_plan.h"

#include <algorithm>
#include <cstddef>

#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

// Of a tree whose deep levels one subgroup takes: it would take too long for those of a larger one.
constexpr std::uint32_t most_leaves_of_a_subgroup = 1u << 20;

// Above a node of level k there are k nodes of WIDE_LEAST_CHILDREN children at least, one of them on its way.
std::uint32_t bound_levels(std::uint32_t leaves) {
  if (leaves < 2) return leaves;
  return std::min(WIDE_MAX_HEIGHT, (leaves - 2) / (WIDE_LEAST_CHILDREN - 1) + 1);
}

// A slot in the place of another, `first_byte` bytes behind its beginning.
template <class T, class Old>
Slot<T> instead_of(const Slot<Old>& old, std::uint64_t first_byte, std::uint64_t count) {
  if (first_byte + count * sizeof(T) > old.bytes())
    throw LayoutError("no room for the scratch of wide nodes");
  return {{old.place.block, old.place.offset + first_byte}, count};
}

void use_scratch_of(const BuildPlan& finished, WidePlan& plan, std::uint32_t bound) {
  const std::uint64_t behind_entries = std::uint64_t{bound} * (sizeof(WideEntry) + sizeof(uint));
  plan.children = instead_of<uint>(finished.clusters[0], 0, std::uint64_t{bound} * WIDE_CHILDREN);
  plan.entries = instead_of<WideEntry>(finished.boxes, 0, bound);
  plan.offsets = instead_of<uint>(finished.boxes, behind_entries, bound);
}

// What refits go by is kept apart if it is to be kept.
void add_scratch(Layout& layout, WidePlan& plan, std::uint32_t bound, const BuildPlan* finished, bool keep) {
  const std::uint64_t children = std::uint64_t{bound} * WIDE_CHILDREN;
  const std::uint64_t entries_bytes = std::uint64_t{bound} * sizeof(WideEntry);
  if (finished && !keep) {
    use_scratch_of(*finished, plan, bound);
  } else {
    const Memory kept = keep ? Memory::update : Memory::scratch;
    plan.children = layout.add<uint>("wide_children", children, kept);
    plan.entries = layout.add<WideEntry>("wide_entries", bound, kept);
    plan.offsets = layout.add<uint>("wide_offsets", bound, kept);
  }
  plan.sizes = finished ? instead_of<uint>(finished->boxes, entries_bytes, bound)
                        : layout.add<uint>("wide_sizes", bound);
}

}  // namespace

std::uint32_t wide_nodes_bound(std::uint32_t leaves) {
  if (leaves < 2) return leaves;
  return static_cast<std::uint32_t>(3 * std::uint64_t{leaves} / 5);
}

WidePlan plan_wide(Layout& layout, TreeSlots& tree, const BuildPlan* finished, std::uint32_t max_turns,
                   bool keep) {
  WidePlan plan;
  const auto leaves = static_cast<std::uint32_t>((tree.nodes.count + 1) / 2);
  const std::uint32_t bound = wide_nodes_bound(leaves);
  plan.levels_bound = bound_levels(leaves);
  // Deep levels may have most of the nodes, as those of a fine mesh at the end of a chain.
  const bool few = leaves <= most_leaves_of_a_subgroup && max_turns == 0xffffffffu;
  plan.dispatched_levels = few ? WIDE_DISPATCHED_LEVELS : WIDE_MAX_HEIGHT;
  plan.levels = layout.add<WideLevel>("wide_levels", plan.levels_bound + 1);
  // Each level begins a tile and a block of its own.
  plan.tile_sums = layout.add<uint>("wide_tile_sums", divide_up(bound, WIDE_TILE) + plan.levels_bound);
  plan.block_sums =
      layout.add<uint>("wide_block_sums", divide_up(bound, WIDE_TILE * WIDE_BLOCK) + plan.levels_bound);
  add_scratch(layout, plan, bound, finished, keep);
  tree.wide_nodes = layout.add<WideNode>("wide_nodes", bound, Memory::tree);
  tree.wide_counts = layout.add<WideCounts>("wide_counts", 1, Memory::tree);
  return plan;
}

WidePlan without_update(const WidePlan& plan, const BuildPlan& finished) {
  WidePlan once = plan;
  use_scratch_of(finished, once, static_cast<std::uint32_t>(plan.entries.count));
  return once;
}

WidePlan with_count(const WidePlan& plan, std::uint32_t leaves) {
  WidePlan fewer = plan;
  fewer.levels_bound = bound_levels(leaves);
  return fewer;
}

void append_wide_boxes(Chain& chain, const TreeSlots& tree, const WidePlan& plan) {
  if (plan.levels_bound == 0) return;
  const auto counts = chain.at(tree.wide_counts);
  chain.run_indirect(
      stages::wide_quantise,
      {chain.at(tree.nodes), chain.at(plan.entries), chain.at(plan.children), chain.at(plan.offsets), counts,
       chain.at(tree.wide_nodes)},
      Place{tree.wide_counts.place.block, tree.wide_counts.place.offset + offsetof(WideCounts, groups)});
}

void append_wide(Chain& chain, const TreeSlots& tree, const WidePlan& plan) {
  chain.clear(tree.wide_counts);
  chain.clear(plan.levels);
  chain.clear(plan.tile_sums);
  chain.clear(plan.block_sums);
  if (plan.levels_bound == 0) return;
  const auto indirect_groups_of = [&](std::uint32_t level) {
    return Place{plan.levels.place.block,
                 plan.levels.place.offset + level * sizeof(WideLevel) + offsetof(WideLevel, groups)};
  };
  const auto entries = chain.at(plan.entries);
  const auto children = chain.at(plan.children), sizes = chain.at(plan.sizes);
  const auto offsets = chain.at(plan.offsets);
  const auto levels = chain.at(plan.levels);
  const auto counts = chain.at(tree.wide_counts);
  WideCollapseArgs collapse{chain.at(tree.nodes),
                            entries,
                            children,
                            chain.at(plan.tile_sums),
                            chain.at(plan.block_sums),
                            levels,
                            counts,
                            chain.at(tree.state),
                            0,
                            0};
  chain.run(stages::wide_root, collapse, {1, 1, 1});
  const std::uint32_t dispatched = std::min(plan.levels_bound, plan.dispatched_levels);
  for (; collapse.level < dispatched; ++collapse.level)
    chain.run_indirect(stages::wide_collapse, collapse, indirect_groups_of(collapse.level));
  if (dispatched < plan.levels_bound) {
    const Place groups = indirect_groups_of(dispatched);  // none in most trees; of more only one works
    chain.run_indirect(stages::wide_collapse_rest,
                       {collapse.nodes,
                        {entries.value},
                        {children.value},
                        collapse.tile_sums,
                        collapse.block_sums,
                        {levels.value},
                        counts,
                        collapse.state,
                        dispatched,
                        plan.levels_bound},
                       groups);
    chain.run_indirect(stages::wide_sizes_rest,
                       {entries, {sizes.value}, offsets, levels, dispatched, plan.levels_bound}, groups);
  }
  for (std::uint32_t level = dispatched; level-- > 0;)
    chain.run_indirect(stages::wide_sizes, {entries, sizes, offsets, levels, level, 0},
                       indirect_groups_of(level));
  append_wide_boxes(chain, tree, plan);
}

}  // namespace coppice
