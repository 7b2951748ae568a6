#include <algorithm>
#include <cstddef>
#include <vector>

#include "pipeline/build_plan.h"
#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

// max_triangles is what one dispatch of the smallest tile reaches.
static_assert(std::min({GATHER_TRIANGLES_TILE, PRIMITIVE_BOUNDS_TILE, MORTON_TILE, SORT_HISTOGRAM_TILE,
                        SORT_RUNS_TILE, SORT_MATCH_TILE, SORT_SCAN_TILE, PLOC_LEAVES_TILE}) >=
              PLOC_MERGE_TILE);
static_assert(PLOC_FINISH_CLUSTERS <= PLOC_MERGE_TILE, "the finish takes its clusters for one tile");

void append_morton_codes(Chain& chain, const BuildPlan& plan, UintBuffer count_at) {
  const std::uint32_t n = plan.triangle_count;
  chain.run(stages::morton_codes,
            {chain.at(plan.boxes), chain.at(plan.state), chain.at(plan.unsorted_keys),
             chain.at(plan.unsorted_values), count_at, n, plan.options.morton_bits / 30},
            groups_of(n, MORTON_TILE));
}

void clear_sort(Chain& chain, const BuildPlan& plan) {
  chain.clear(plan.histogram);
  chain.clear(plan.sort_status);
  chain.clear(plan.sort_tickets);
}

bool has_values(const BuildPlan& plan) { return plan.values[0].count > 0; }

// None of keys alone.
Address<uint> values_at(const Chain& chain, const BuildPlan& plan, int side) {
  return has_values(plan) ? chain.at(plan.values[side]) : Address<uint>{};
}

void append_onesweep(Chain& chain, const BuildPlan& plan, UintBuffer count_at) {
  const std::uint32_t n = plan.triangle_count, key_words = plan.options.morton_bits / 30;
  const SortPlan& sort = plan.sort;
  chain.run(stages::sort_histogram,
            {chain.at(plan.unsorted_keys), chain.at(plan.histogram), count_at, n, key_words},
            groups_of(n, SORT_HISTOGRAM_TILE, key_words));
  chain.run(stages::sort_digit_scan, {chain.at(plan.histogram), sort.passes, 0}, {sort.passes, 1, 1});
  const SortPassConstants constants{lookback_constants(plan.options), sort.match,
                                    sort.match ? SORT_MATCH_GROUP : SORT_RUNS_GROUP, has_values(plan)};
  for (std::uint32_t pass = 0; pass < sort.passes; ++pass) {
    const int in = (sort.passes - pass) % 2, out = 1 - in;
    chain.run(stages::sort_pass,
              {chain.at(plan.keys[in]), values_at(chain, plan, in), chain.at(plan.keys[out]),
               values_at(chain, plan, out), chain.at(plan.histogram, pass * SORT_DIGITS),
               chain.at(plan.sort_status, std::uint64_t{pass} * sort.tile_count * SORT_DIGITS),
               chain.at(plan.sort_tickets, pass), chain.at(plan.state), count_at, n, key_words, pass,
               sort.tile_keys},
              counted_groups(n, sort.tile_keys, count_at), constants);
  }
}

void append_scanned_sort(Chain& chain, const BuildPlan& plan, UintBuffer count_at) {
  const SortPlan& sort = plan.sort;
  const std::uint32_t key_words = plan.options.morton_bits / 30, bits = sort.digit_bits;
  for (std::uint32_t pass = 0; pass < sort.passes; ++pass) {
    const int in = (sort.passes - pass) % 2, out = 1 - in;
    const SortScatterArgs args{chain.at(plan.keys[in]),
                               values_at(chain, plan, in),
                               chain.at(plan.keys[out]),
                               values_at(chain, plan, out),
                               chain.at(plan.sort_digits),
                               chain.at(plan.state),
                               count_at,
                               plan.triangle_count,
                               key_words,
                               pass / sort.passes_per_word,
                               pass % sort.passes_per_word * bits,
                               bits,
                               sort.tile_keys};
    const bool one_tile = sort.tile_count <= 1;  // it counts and scans for itself
    if (!one_tile) {
      chain.run(stages::sort_tile_counts, args, {sort.tile_count, 1, 1}, {bits, key_words});
      chain.run(stages::sort_tile_scan, {args.tile_digits, count_at, args.count, sort.tile_keys, bits, 0},
                {1, 1, 1}, {bits});
    }
    chain.run(stages::sort_scatter, args, counted_groups(args.count, sort.tile_keys, count_at),
              {{bits, key_words}, has_values(plan), one_tile});
  }
}

void append_sort_passes(Chain& chain, const BuildPlan& plan, UintBuffer count_at) {
  if (plan.sort.onesweep)
    append_onesweep(chain, plan, count_at);
  else
    append_scanned_sort(chain, plan, count_at);
}

void append_round(Chain& chain, const BuildPlan& plan, std::uint32_t round) {
  const int in = round % 2, out = 1 - in;
  const auto groups = [&](std::size_t member) {
    return Place{plan.rounds.place.block, plan.rounds.place.offset + round * sizeof(PlocRound) + member};
  };
  const auto status = chain.at(plan.round_status[in]);
  const PlocMergeArgs args{chain.at(plan.clusters[in]),
                           chain.at(plan.clusters[out]),
                           chain.at(plan.partners),
                           status,
                           chain.at(plan.round_status[out]),
                           chain.at(plan.nodes),
                           chain.at(plan.state),
                           chain.at(plan.rounds),
                           round,
                           plan.options.lookback,
                           plan.options.radius,
                           0};
  const Place merge_groups = groups(offsetof(PlocRound, merge_groups));
  const PlocMergeConstants constants{lookback_constants(plan.options), plan.options.radius};
  if (!plan.options.lookback) {
    chain.run_indirect(stages::ploc_tile_counts, args, merge_groups, constants);
    chain.run_indirect(stages::ploc_tile_scan, {status, chain.at(plan.rounds), round, 0},
                       groups(offsetof(PlocRound, tile_scan_groups)));
  }
  chain.run_indirect(stages::ploc_merge, args, merge_groups, constants);
}

void append_ploc(Chain& chain, const BuildPlan& plan) {
  chain.run(stages::ploc_leaves,
            {chain.at(plan.boxes), chain.at(plan.values[0]), chain.at(plan.clusters[0]), chain.at(plan.state),
             chain.at(plan.rounds), plan.triangle_count, 0},
            groups_of(plan.triangle_count, PLOC_LEAVES_TILE));
  for (std::uint32_t round = 0; round < plan.recorded_rounds; ++round) append_round(chain, plan, round);
  chain.run(stages::ploc_finish,
            {chain.at(plan.clusters[0]), chain.at(plan.clusters[1]), chain.at(plan.nodes),
             chain.at(plan.state), chain.at(plan.rounds), plan.options.radius, plan.rounds_bound},
            {1, 1, 1}, {plan.options.radius});
}

// One dispatch builds the whole tree.
void append_hploc(Chain& chain, const BuildPlan& plan) {
  const std::uint32_t tile_count = groups_of(plan.triangle_count, HPLOC_TILE).x;
  const std::uint32_t rows = groups_of(tile_count, 65535).x;
  const std::uint32_t cluster_limit = plan.options.builder == DeviceBuilder::lbvh ? 1 : HPLOC_CLUSTERS;
  chain.run(stages::hploc_build,
            {chain.at(plan.boxes), chain.at(plan.keys[0]), chain.at(plan.values[0]), chain.at(plan.nodes),
             chain.at(plan.clusters[0]), chain.at(plan.cluster_names), chain.at(plan.arrivals),
             chain.at(plan.state), plan.options.morton_bits / 30, plan.options.radius, cluster_limit, 0},
            rows == 0 ? uvec3(0) : groups_of(tile_count, rows, rows), {cluster_limit, plan.options.radius});
}

}  // namespace

LookbackConstants lookback_constants(const BuildOptions& options) {
  return {options.lookback_turns, options.lookback_max_fallbacks, options.lookback_stress};
}

std::span<const NamedDeviceBuilder> device_builders() {
  static constexpr NamedDeviceBuilder builders[] = {{"gpu-ploc", DeviceBuilder::ploc, "ploc-parallel"},
                                                    {"gpu-hploc", DeviceBuilder::hploc, "hploc"},
                                                    {"gpu-lbvh", DeviceBuilder::lbvh, "lbvh"}};
  return builders;
}

const NamedDeviceBuilder* find_device_builder(std::string_view name) {
  for (const NamedDeviceBuilder& named : device_builders()) {
    if (named.name == name) return &named;
  }
  return nullptr;
}

void append_sort(Chain& chain, const BuildPlan& plan, UintBuffer count_at) {
  clear_sort(chain, plan);
  append_sort_passes(chain, plan, count_at);
}

void append_build(Chain& chain, const BuildPlan& plan, const BuildInput& input) {
  chain.clear(plan.state);
  chain.clear(plan.rounds);
  chain.clear(plan.round_status[0]);
  chain.clear(plan.arrivals);
  clear_sort(chain, plan);
  append_primitives(chain, {plan.triangle_count, plan.triangles, plan.boxes, plan.state}, input);
  append_morton_codes(chain, plan, input.count_at);
  append_sort_passes(chain, plan, input.count_at);
  if (plan.options.builder == DeviceBuilder::ploc)
    append_ploc(chain, plan);
  else
    append_hploc(chain, plan);
}

}  // namespace coppice
