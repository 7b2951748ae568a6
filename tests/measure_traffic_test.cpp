// The bytes that stages move by their models, against numbers worked out by hand, and the limit by copies.
#include <gtest/gtest.h>

#include <map>

#include "measure/copy_limit.h"
#include "measure/traffic.h"
#include "pipeline/batch.h"
#include "pipeline/build_plan.h"
#include "pipeline/instances.h"
#include "pipeline/refit.h"
#include "pipeline/scan_plan.h"
#include "pipeline/wide_plan.h"
#include "stages/stages.h"

namespace coppice {
namespace {

constexpr std::uint32_t triangles = 20000;
constexpr std::array<std::uint64_t, 4> no_addresses{};

PlocRound round_of(uint clusters, uint merged_before, uint groups, uint pair_all = 0) {
  PlocRound round{};
  round.cluster_count = clusters;
  round.merged_before = merged_before;
  round.pair_all = pair_all;
  round.merge_groups.x = groups;
  return round;
}

// 20,000 triangles of which 19,000 are active: 19,000 clusters become 3,000 and then 500 for the finish.
RunCounts two_rounds() {
  RunCounts counts;
  counts.active_count = 19000;
  counts.rounds = {round_of(19000, 0, 19), round_of(3000, 16000, 3, 1), round_of(500, 18500, 0),
                   round_of(1, 18999, 0)};
  return counts;
}

std::map<std::string, std::uint64_t> bytes_of(const BuildOptions& options) {
  Layout layout;
  const BuildPlan plan = plan_build(layout, triangles, options);
  Chain chain(no_addresses);
  append_build(chain, plan);
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, two_rounds());
  }
  return bytes;
}

TEST(Traffic, OfABuildWithLookback) {
  auto bytes = bytes_of({.radius = 16, .morton_bits = 30});
  EXPECT_EQ(bytes["primitive_bounds"], 1200000u);               // 60 a triangle
  EXPECT_EQ(bytes["morton_codes"], 640000u);                    // 32
  EXPECT_EQ(bytes["sort_histogram"], 80000u);                   // 4
  EXPECT_EQ(bytes["sort_digit_scan"], 8192u);                   // 2 KiB a pass
  EXPECT_EQ(bytes["sort_pass"], 4u * (320000 + 2 * 3 * 1024));  // two tiles of 16,384 keys
  EXPECT_EQ(bytes["ploc_leaves"], 1140000u);                    // 60 an active triangle
  EXPECT_EQ(bytes["ploc_merge"], 68u * 22000 + 32 * (16000 + 2500));
  EXPECT_EQ(bytes["ploc_finish"], 32u * 500 + 32 * 999);
}

TEST(Traffic, OfABuildWithoutLookbackAndWith60Bits) {
  auto bytes = bytes_of({.radius = 8, .morton_bits = 60, .lookback = false});
  EXPECT_EQ(bytes["morton_codes"], 720000u);
  EXPECT_EQ(bytes["sort_tile_counts"], 6u * (80000 + 2 * 8192));  // 6 passes, 2 tiles, 2,048 digits
  EXPECT_EQ(bytes["sort_tile_scan"], 6u * 2 * 2 * 8192);
  EXPECT_EQ(bytes["sort_scatter"], 6u * (480000 + 2 * 2 * 8192));
  EXPECT_EQ(bytes["ploc_tile_counts"], 4u * 22000 + 32 * 19000 + 8 * 22);  // the second round pairs all
  EXPECT_EQ(bytes["ploc_tile_scan"], 24u * 22);
}

// 1,000 leaves under 999 inner nodes: 400 of height 1 have 800 of them, 599 of height 2 (as if that could be)
// the rest.
TEST(Traffic, OfARefit) {
  RunCounts counts;
  counts.active_count = 1000;
  counts.refit_levels.resize(3);
  counts.refit_levels[0].count = 400;
  counts.refit_levels[1].count = 599;
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 1600, 2 * 1600 - 1);
  const RefitPlan refit = plan_refit(layout, tree);
  Chain chain(no_addresses);
  append_refit_order(chain, tree, refit);
  append_refit(chain, tree, refit);
  append_tree_cost(chain, tree, refit);
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts);
  }
  EXPECT_EQ(bytes["refit_absent"], 36u * 1600 + 200);
  EXPECT_EQ(bytes["refit_keys"], 32u * 1999 + 8 * 999);
  EXPECT_EQ(bytes["refit_levels"], 36u * 257);
  EXPECT_EQ(bytes["refit_appeared"], 200u + 36 * 600);
  EXPECT_EQ(bytes["refit_boxes"], 100u * 999 + 68 * 1000);
  EXPECT_EQ(bytes["refit_rest"], 0u);
  EXPECT_EQ(bytes["tree_areas"], 32u * 1999 + 4 * 2);
  EXPECT_EQ(bytes["tree_area_sum"], 4u * 2 + 32);
  counts.primitive_count = 1000;  // all are in leaves
  for (const Step& step : chain.steps()) {
    if (stage_of(step) == &stages::refit_absent || stage_of(step) == &stages::refit_appeared) {
      EXPECT_EQ(modelled_bytes(step, counts), 0u);
    }
  }
}

TEST(Traffic, OfTwoLevels) {
  Layout layout;
  constexpr std::uint32_t meshes[] = {100, 7};
  InstancePlan plan = plan_instances(layout, meshes, 1000, {});
  const RaySlots rays{layout.add<Ray>("rays", 100),
                      layout.add<Hit>("hits", 100),
                      layout.add<TraceCounters>("counters", 1),
                      {}};
  const PlacedHitSlots hits = plan_placed_hits(layout, plan, 100);
  Chain chain(no_addresses);
  append_moves(chain, plan, {plan.transforms, layout.add<uint>("turn", 1)}, 1);
  append_top(chain, plan);
  append_instance_hits(chain, plan, rays, hits.hit_instances, 100, {});
  append_placed_hits(chain, plan, rays, hits, 0, 100);
  RunCounts counts;
  counts.active_count = 1000;
  counts.rays = 100, counts.hits = 50, counts.steps = 400;
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts);
  }
  EXPECT_EQ(bytes["move_instances"], 96000u);
  EXPECT_EQ(bytes["instance_boxes"], 140000u);
  EXPECT_EQ(bytes["box_bounds"], 48000u);
  EXPECT_EQ(bytes["trace_instances"], 100u * 68 + 400 * 64 + 50 * 148);
  EXPECT_EQ(bytes["place_hits"], 100u * 60 + 50 * 96);
  const TopRefit refit = plan_top_refit(layout, plan, 100);
  Chain again(no_addresses);
  append_top_refit(again, plan, refit);
  for (const Step& step : again.steps()) {
    if (stage_of(step) == &stages::instance_boxes) {
      EXPECT_EQ(modelled_bytes(step, counts), 176000u) << "and the triangles that are refitted";
    }
  }
}

// 64 triangles under 9 wide nodes: the root has 8, which have 8 leaves each.
TEST(Traffic, OfWideNodes) {
  RunCounts counts;
  counts.active_count = 64;
  counts.wide_nodes = 9;
  counts.wide_levels.resize(3);
  counts.wide_levels[0].count = 1;
  counts.wide_levels[1].count = 8;
  Layout layout;
  TreeSlots tree = plan_tree(layout, 64, 127);
  const WidePlan plan = plan_wide(layout, tree);
  Chain chain(no_addresses);
  append_wide(chain, tree, plan);
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts);
  }
  EXPECT_EQ(bytes["wide_root"], 48u + 7 * 64);
  EXPECT_EQ(bytes["wide_collapse"], 9 * 48u + 8 * 48 + 56 * 64);
  EXPECT_EQ(bytes["wide_sizes"], 9 * 20u + 8 * 8);
  EXPECT_EQ(bytes["wide_quantise"], 9 * (148u + 32) + 72 * 32);
}

// Where the device has the number, what it says counts, and at most what was planned for.
TEST(Traffic, OfACountOnTheDevice) {
  for (const std::uint32_t variant : {SORT_SCAN_8, SORT_ONESWEEP_RUNS}) {
    BuildOptions options{.radius = 16, .morton_bits = 30};
    options.variants.sort = variant;
    const auto moved = [&](std::uint32_t planned, bool counted, std::uint32_t there) {
      Layout layout;
      const BuildPlan plan = plan_build(layout, planned, options);
      Chain chain(no_addresses);
      append_build(chain, plan, {.count_at = {counted ? 4096u : 0u}});
      RunCounts counts = two_rounds();
      counts.primitive_count = there;
      std::uint64_t bytes = 0;
      for (const Step& step : chain.steps()) {
        if (stage_of(step)) bytes += modelled_bytes(step, counts);
      }
      return bytes;
    };
    EXPECT_EQ(moved(100000, true, 20000), moved(20000, false, 0));
    EXPECT_EQ(moved(100000, true, 200000), moved(100000, false, 0));
    EXPECT_LT(moved(100000, true, 20000), moved(100000, true, 40000));
  }
}

TEST(Traffic, OfVerticesBoxesAndABatch) {
  Layout layout;
  const PrimitiveSlots gathered = plan_primitives(layout, 1000, PrimitiveKind::triangles);
  const PrimitiveSlots given = plan_primitives(layout, 1000, PrimitiveKind::boxes);
  const BatchPlan batch = plan_batch(layout, 6400, 100, {});
  Chain chain(no_addresses);
  append_primitives(chain, gathered, {VertexTriangles{.indices = {4096}, .index_bytes = 2}, {}});
  append_primitives(chain, given, {GivenBoxes{}, {}});
  append_batch(chain, batch);
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (const auto* stage = stage_of(step)) bytes[stage->name] += modelled_bytes(step, {});
  }
  EXPECT_EQ(bytes["gather_triangles"], 1000u * (36 + 6 + 36));
  EXPECT_EQ(bytes["box_bounds"], 1000u * 48);
  EXPECT_EQ(bytes["primitive_bounds"], 7400u * 60);
  EXPECT_EQ(bytes["batch_build"], 100u * 24 + 6400 * 88);
}

TEST(Traffic, OfAScanWithAndWithoutLookback) {
  for (const bool lookback : {true, false}) {
    Layout layout;
    BuildOptions options;
    options.lookback = lookback;
    const ScanPlan plan = plan_scan(layout, 40000, options);  // three tiles of 16,384 words
    Chain chain(no_addresses);
    append_scan(chain, plan);
    std::map<std::string, std::uint64_t> bytes;
    for (const Step& step : chain.steps()) {
      if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, {});
    }
    EXPECT_EQ(bytes["scan_tile_sums"], lookback ? 0u : 160000u + 3 * 4);
    EXPECT_EQ(bytes["prefix_scan"], lookback ? 320000u + 3 * 24 : 320000u + 3 * 4 + 2 * 12 + 4);
  }
}

TEST(Traffic, OfASortOfKeysAlone) {
  Layout layout;
  const BuildPlan plan = plan_sort(layout, triangles, {.morton_bits = 60}, false);
  Chain chain(no_addresses);
  append_sort(chain, plan);
  std::uint64_t bytes = 0;
  for (const Step& step : chain.steps()) {
    if (stage_of(step) == &stages::sort_pass) bytes += modelled_bytes(step, {});
  }
  EXPECT_EQ(bytes, 8u * (320000 + 2 * 3 * 1024));
}

TEST(CopyLimit, IsLinearBetweenMeasurements) {
  const CopyLimit limit({{1000, 1.0}, {2000, 1.5}, {8000, 4.5}});
  EXPECT_DOUBLE_EQ(limit.ms(0), 1.0);
  EXPECT_DOUBLE_EQ(limit.ms(1000), 1.0);
  EXPECT_DOUBLE_EQ(limit.ms(1500), 1.25);
  EXPECT_DOUBLE_EQ(limit.ms(4000), 2.5);
  EXPECT_DOUBLE_EQ(limit.ms(8000), 4.5);
  EXPECT_DOUBLE_EQ(limit.ms(16000), 9.0);
}

}  // namespace
}  // namespace coppice
