#include "pipeline/build_plan.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "interface/sort.h"
#include "stages/divide_up.h"

namespace coppice {

namespace {

void set_rounds(BuildPlan& plan) {
  plan.rounds_bound = ploc_rounds_bound(plan.triangle_count, 1);
  plan.recorded_rounds = ploc_rounds_bound(plan.triangle_count, PLOC_FINISH_CLUSTERS);
}

void add_ploc_slots(Layout& layout, BuildPlan& plan) {
  const std::uint32_t n = plan.triangle_count;
  set_rounds(plan);
  plan.rounds = layout.add<PlocRound>("rounds", plan.rounds_bound + 1);
  plan.clusters[0] = layout.add<Node>("clusters_even", n);
  plan.clusters[1] = layout.add<Node>("clusters_odd", n);
  plan.partners = layout.add<uint>("partners", n);
  for (int i = 0; i < 2; ++i) {
    plan.round_status[i] = layout.add<uint>(i ? "round_status_odd" : "round_status_even",
                                            std::uint64_t{divide_up(n, PLOC_MERGE_TILE)} * PLOC_MERGE_SUMS);
  }
}

void add_hploc_slots(Layout& layout, BuildPlan& plan) {
  plan.clusters[0] = layout.add<Node>("clusters", plan.triangle_count);
  plan.cluster_names = layout.add<uint>("cluster_names", plan.triangle_count);
  plan.arrivals = layout.add<uint>("arrivals", plan.triangle_count);
}

constexpr std::uint32_t wide_digit_keys = 1u << 18;  // above, so many digits at once miss the caches
constexpr std::uint32_t most_scanned_tiles = 1024;

SortPlan plan_passes(std::uint32_t key_count, const BuildOptions& options) {
  const std::uint32_t variant = options.variants.sort;
  SortPlan sort;
  sort.match = variant == SORT_ONESWEEP_MATCH;
  sort.onesweep = options.lookback && (sort.match || variant == SORT_ONESWEEP_RUNS);
  if (sort.onesweep) {
    sort.digit_bits = SORT_DIGIT_BITS;
    sort.tile_keys = sort.match ? SORT_MATCH_TILE : SORT_RUNS_TILE;
  } else {
    const bool by_size = variant != SORT_SCAN_8 && variant != SORT_SCAN_11;
    const bool wide = by_size ? key_count <= wide_digit_keys : variant == SORT_SCAN_11;
    sort.digit_bits = wide ? SORT_WIDE_BITS : SORT_NARROW_BITS;
    sort.tile_keys = SORT_SCAN_TILE;
    while (divide_up(key_count, sort.tile_keys) > most_scanned_tiles) sort.tile_keys *= 2;
  }
  sort.tile_count = divide_up(key_count, sort.tile_keys);
  sort.passes_per_word = divide_up(32u, sort.digit_bits);
  sort.passes = options.morton_bits / 30 * sort.passes_per_word;
  return sort;
}

// Where the sort of a plan's first primitives begins.
void set_sort(BuildPlan& plan) {
  plan.sort = plan_passes(plan.triangle_count, plan.options);
  plan.unsorted_keys = plan.keys[plan.sort.passes % 2];
  plan.unsorted_values = plan.values[plan.sort.passes % 2];
}

// Large enough for a sort of any number of fewer keys, too: their digits may be wider.
std::uint64_t most_tile_digits(std::uint32_t key_count, const BuildOptions& options) {
  const auto digits = [&](std::uint32_t count) {
    const SortPlan sort = plan_passes(count, options);
    // Where tiles get larger there are fewer of more keys.
    const std::uint32_t most = std::min(divide_up(count, SORT_SCAN_TILE), most_scanned_tiles);
    return std::uint64_t{sort.onesweep ? sort.tile_count : most} << sort.digit_bits;
  };
  return std::max(digits(key_count), digits(std::min(key_count, wide_digit_keys)));
}

// `keys` and `values`: who keeps what is sorted in the end.
void add_sort_slots(Layout& layout, BuildPlan& plan, bool has_values, Memory keys, Memory values) {
  const std::uint32_t n = plan.triangle_count;
  const std::uint32_t key_words = plan.options.morton_bits / 30;
  plan.keys[0] = layout.add<uint>("keys_a", std::uint64_t{n} * key_words, keys);
  plan.values[0] = layout.add<uint>("values_a", has_values ? n : 0, values);
  plan.keys[1] = layout.add<uint>("keys_b", std::uint64_t{n} * key_words);
  plan.values[1] = layout.add<uint>("values_b", has_values ? n : 0);
  set_sort(plan);
  const SortPlan& sort = plan.sort;
  const std::uint64_t tile_digits = most_tile_digits(n, plan.options);
  if (sort.onesweep) {
    plan.histogram = layout.add<uint>("histogram", sort.passes * SORT_DIGITS);
    plan.sort_status = layout.add<uint>("sort_status", sort.passes * tile_digits);
    plan.sort_tickets = layout.add<uint>("sort_tickets", sort.passes);
  } else {
    plan.sort_digits = layout.add<uint>("sort_digits", tile_digits);
  }
}

}  // namespace

BuildPlan plan_sort(Layout& layout, std::uint32_t key_count, const BuildOptions& options, bool has_values) {
  BuildPlan plan;
  plan.options = options;
  plan.triangle_count = key_count;
  plan.state = layout.add<BuildState>("state", 1);
  add_sort_slots(layout, plan, has_values, Memory::keys, Memory::values);
  return plan;
}

BuildOptions sorted_in_place(BuildOptions options) {
  if (!options.lookback || options.variants.sort == SORT_SCAN || options.variants.sort == SORT_SCAN_11)
    options.variants.sort = SORT_SCAN_8;
  return options;
}

std::uint32_t ploc_rounds_bound(std::uint32_t clusters, std::uint32_t target) {
  if (clusters <= target) return 0;
  std::uint32_t epoch = 0;
  while (clusters >> epoch > target) ++epoch;
  return PLOC_EPOCH_ROUNDS * epoch + 2;
}

TreeSlots plan_tree(Layout& layout, std::uint32_t triangle_count, std::uint64_t node_count) {
  TreeSlots tree;
  tree.triangle_count = triangle_count;
  tree.triangles = layout.add<Triangle>("triangles", triangle_count, Memory::tree);
  tree.nodes = layout.add<Node>("nodes", node_count, Memory::tree);
  tree.state = layout.add<BuildState>("state", 1, Memory::tree);
  return tree;
}

void check_build(std::uint32_t primitive_count, const BuildOptions& options) {
  if (options.radius < 1 || options.radius > PLOC_MAX_RADIUS) {
    throw std::invalid_argument("radius " + std::to_string(options.radius) + " is not in 1 to " +
                                std::to_string(PLOC_MAX_RADIUS));
  }
  if (options.morton_bits != 30 && options.morton_bits != 60) {
    throw std::invalid_argument("Morton codes have 30 or 60 bits, not " +
                                std::to_string(options.morton_bits));
  }
  if (primitive_count > max_triangles) {
    throw std::invalid_argument(std::to_string(primitive_count) + " triangles are more than a build takes, " +
                                std::to_string(max_triangles));
  }
}

BuildPlan plan_build(Layout& layout, std::uint32_t primitive_count, const BuildOptions& options,
                     PrimitiveKind kind) {
  check_build(primitive_count, options);
  BuildPlan plan;
  const std::uint32_t n = primitive_count;
  plan.options = options;

  const std::uint32_t triangle_count = kind == PrimitiveKind::triangles ? n : 0;
  static_cast<TreeSlots&>(plan) = plan_tree(layout, triangle_count, n == 0 ? 0 : 2 * std::uint64_t{n} - 1);
  plan.triangle_count = n;
  plan.boxes = layout.add<Aabb>("boxes", n);
  add_sort_slots(layout, plan, true, Memory::scratch, Memory::scratch);
  if (options.builder == DeviceBuilder::ploc)
    add_ploc_slots(layout, plan);
  else
    add_hploc_slots(layout, plan);
  return plan;
}

BuildPlan with_count(const BuildPlan& plan, std::uint32_t primitive_count) {
  BuildPlan fewer = plan;
  fewer.triangle_count = primitive_count;
  set_sort(fewer);
  if (fewer.options.builder == DeviceBuilder::ploc) set_rounds(fewer);
  return fewer;
}

}  // namespace coppice
