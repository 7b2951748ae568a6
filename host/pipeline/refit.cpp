#include "pipeline/refit.h"

#include <algorithm>
#include <cstddef>

#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

static_assert(REFIT_MAX_HEIGHT * 4 == 1u << REFIT_KEY_BITS && REFIT_KEY_BITS <= SORT_WIDE_BITS);
static_assert(std::uint64_t{max_triangles} * 2 / REFIT_KEYS_TILE <= 2 * 65535u);

constexpr std::uint32_t most_scanned_tiles = 1024;

std::uint32_t leaves_of(const TreeSlots& tree) {
  return static_cast<std::uint32_t>((tree.nodes.count + 1) / 2);
}

// The most that a tree of the plan has.
std::uint32_t nodes_of(const RefitPlan& plan) { return 2 * static_cast<std::uint32_t>(plan.order.count) + 1; }

// The first `count` entries of an old slot.
Slot<uint> first_of(const Slot<uint>& old, std::uint64_t count) {
  check_fits(old, count);
  return {old.place, count};
}

void set_tiles(RefitPlan& plan, std::uint32_t pairs) {
  plan.tile_keys = SORT_SCAN_TILE;
  while (divide_up(pairs, plan.tile_keys) > most_scanned_tiles) plan.tile_keys *= 2;
}

// One pass of the radix sort, by keys: what is sorted are the parents.
void append_sort_by_height(Chain& chain, const RefitPlan& plan) {
  const auto pairs = static_cast<std::uint32_t>(plan.order.count);
  const SortScatterArgs args{chain.at(plan.keys[0]),
                             chain.at(plan.parents),
                             chain.at(plan.keys[1]),
                             chain.at(plan.order),
                             chain.at(plan.tile_digits),
                             chain.at(plan.sort_state),
                             chain.at(plan.pair_count),
                             pairs,
                             1,
                             0,
                             0,
                             REFIT_KEY_BITS,
                             plan.tile_keys};
  const std::uint32_t tiles = divide_up(pairs, plan.tile_keys);
  if (tiles > 1) {
    chain.run(stages::sort_tile_counts, args, {tiles, 1, 1}, {REFIT_KEY_BITS, 1});
    chain.run(stages::sort_tile_scan,
              {args.tile_digits, args.count_at, args.count, plan.tile_keys, REFIT_KEY_BITS, 0}, {1, 1, 1},
              {REFIT_KEY_BITS});
  }
  chain.run(stages::sort_scatter, args, {tiles, 1, 1}, {{REFIT_KEY_BITS, 1}, true, tiles <= 1});
}

uvec3 rows_of(std::uint32_t count, std::uint32_t size) {
  const std::uint32_t groups = divide_up(count, size);
  const std::uint32_t rows = std::max(divide_up(groups, 65535u), 1u);
  return {divide_up(groups, rows), rows, 1};
}

}  // namespace

RefitPlan plan_refit(Layout& layout, const TreeSlots& tree, const BuildPlan* finished,
                     std::uint32_t max_turns, bool keep) {
  RefitPlan plan;
  const std::uint32_t leaves = leaves_of(tree), pairs = leaves == 0 ? 0 : leaves - 1;
  const Memory kept = keep ? Memory::update : Memory::scratch;
  plan.dispatched_levels = max_turns == 0xffffffffu ? REFIT_DISPATCHED_LEVELS : REFIT_MAX_HEIGHT;
  plan.state = layout.add<RefitState>("refit_state", 1, Memory::tree);
  plan.levels = layout.add<RefitLevel>("refit_levels", REFIT_MAX_HEIGHT + 1, kept);
  plan.absent = layout.add<uint>("refit_absent", divide_up(tree.triangle_count, 32u), kept);
  plan.pair_count = layout.add<uint>("refit_pair_count", 1, kept);
  plan.tile_areas = layout.add<float>(
      "tree_tile_areas", divide_up(static_cast<std::uint32_t>(tree.nodes.count), TREE_AREAS_TILE), kept);
  plan.keys[0] = finished ? first_of(finished->keys[0], pairs) : layout.add<uint>("refit_keys", pairs);
  plan.parents = finished ? first_of(finished->values[0], pairs) : layout.add<uint>("refit_parents", pairs);
  plan.keys[1] = finished ? first_of(finished->keys[1], pairs) : layout.add<uint>("refit_sorted_keys", pairs);
  plan.order =
      finished && !keep ? first_of(finished->values[1], pairs) : layout.add<uint>("refit_order", pairs, kept);
  set_tiles(plan, pairs);
  const std::uint32_t most_tiles = std::min(divide_up(pairs, SORT_SCAN_TILE), most_scanned_tiles);
  plan.tile_digits = layout.add<uint>("refit_tile_digits", std::uint64_t{most_tiles} << REFIT_KEY_BITS);
  plan.sort_state = layout.add<BuildState>("refit_sort_state", 1);
  return plan;
}

RefitPlan with_count(const RefitPlan& plan, std::uint32_t leaves) {
  RefitPlan fewer = plan;
  const std::uint32_t pairs = leaves == 0 ? 0 : leaves - 1;
  for (Slot<uint>* const slot : {&fewer.keys[0], &fewer.keys[1], &fewer.parents, &fewer.order})
    *slot = first_of(*slot, pairs);
  set_tiles(fewer, pairs);
  return fewer;
}

void append_refit_order(Chain& chain, const TreeSlots& tree, const RefitPlan& plan) {
  if (tree.nodes.count == 0) return;
  const std::uint32_t nodes = nodes_of(plan);
  chain.run(stages::refit_absent,
            {chain.at(tree.triangles), chain.at(plan.absent), chain.at(tree.state), tree.triangle_count, 0},
            groups_of(tree.triangle_count, REFIT_ABSENT_TILE));
  chain.clear(plan.sort_state);
  chain.run(stages::refit_keys,
            {chain.at(tree.nodes), chain.at(plan.keys[0]), chain.at(plan.parents), chain.at(plan.pair_count),
             chain.at(tree.state), nodes, 0},
            rows_of(nodes, REFIT_KEYS_TILE));
  append_sort_by_height(chain, plan);
  chain.run(stages::refit_levels, {chain.at(plan.keys[1]), chain.at(plan.pair_count), chain.at(plan.levels)},
            {1, 1, 1});
}

void append_refit(Chain& chain, const TreeSlots& tree, const RefitPlan& plan) {
  chain.clear(plan.state);
  if (tree.nodes.count == 0) return;
  chain.run(stages::refit_appeared,
            {chain.at(tree.triangles), chain.at(plan.absent), chain.at(tree.state), chain.at(plan.state),
             tree.triangle_count, 0},
            groups_of(tree.triangle_count, REFIT_ABSENT_TILE));
  RefitBoxesArgs args{
      chain.at(tree.nodes), chain.at(tree.triangles), chain.at(plan.order), chain.at(plan.levels), 0, 0};
  // No tree of so many inner nodes is higher.
  const auto levels =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(plan.dispatched_levels, plan.order.count));
  for (; args.level < levels; ++args.level) {
    const Place level{plan.levels.place.block, plan.levels.place.offset + args.level * sizeof(RefitLevel) +
                                                   offsetof(RefitLevel, groups)};
    chain.run_indirect(stages::refit_boxes, args, level);
  }
  chain.run(stages::refit_rest,
            {args.nodes, args.triangles, args.order, args.levels, chain.at(tree.state), levels, 0},
            {1, 1, 1});
}

void append_tree_cost(Chain& chain, const TreeSlots& tree, const RefitPlan& plan) {
  if (tree.nodes.count == 0) return;
  const std::uint32_t nodes = nodes_of(plan);
  chain.run(stages::tree_areas,
            {chain.at(tree.nodes), chain.at(plan.tile_areas), chain.at(tree.state), nodes, 0},
            rows_of(nodes, TREE_AREAS_TILE));
  chain.run(stages::tree_area_sum,
            {chain.at(tree.nodes), chain.at(plan.tile_areas), chain.at(tree.state), chain.at(plan.state)},
            {1, 1, 1});
}

double sah_cost(const RefitState& state, std::uint32_t leaves) {
  if (leaves == 0) return 0;
  if (state.root_area == 0) return 2.0 * leaves - 1;
  return double{state.area_sum} / double{state.root_area};
}

double sah_cost_error(std::uint32_t leaves) {
  const double tiles = 2.0 * leaves / TREE_AREAS_TILE;
  return 0x1p-24 * (TREE_AREAS_PER_INVOCATION + tiles / TREE_AREAS_GROUP + 40);
}

}  // namespace coppice
