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
#include "pipeline/trace_any.h"
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

// Of 2,000 rays 500 hit something; each step of a ray is kept.
TEST(Traffic, OfWhatIsShown) {
  const auto bytes_of_view = [](uint view, const char* stage) {
    Layout layout;
    const TreeSlots tree = plan_tree(layout, 100, 199);
    TraceOptions options{.width = 40, .height = 50, .show = view};
    const TracePlan plan = plan_trace(layout, tree, 1, options);
    Chain chain(no_addresses);
    append_trace(chain, tree, plan);
    TraceCounters counters{};
    counters.rays.x = 2000;
    counters.hits.x = 500;
    counters.steps.x = 30000;
    for (const Step& step : chain.steps()) {
      if (stage_of(step) && std::string_view(stage_of(step)->name) == stage)
        return modelled_bytes(step, counts_of_trace(counters));
    }
    return std::uint64_t{0};
  };
  EXPECT_EQ(bytes_of_view(SHOW_IDS, "show"), 2000u * (4 + 12));
  EXPECT_EQ(bytes_of_view(SHOW_STEPS, "show"), 2000u * (4 + 12));
  EXPECT_EQ(bytes_of_view(SHOW_DEPTH, "show"), 2000u * (4 + 12) + 500 * 4);
  EXPECT_EQ(bytes_of_view(SHOW_NORMALS, "show"), 2000u * (4 + 12) + 500 * 36);
  EXPECT_EQ(bytes_of_view(SHOW_IDS, "shade"), 0u);
  EXPECT_EQ(bytes_of_view(SHOW_IDS, "trace_closest"), 2000u * 64 + 64 * 30000 + 500 * 36);
  EXPECT_EQ(bytes_of_view(SHOW_STEPS, "trace_closest"), 2000u * 68 + 64 * 30000 + 500 * 36);
}

TEST(Traffic, OfAPictureOfOneSample) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  const TracePlan plan = plan_trace(layout, tree, 1, {.width = 40, .height = 25});
  Chain chain(no_addresses);
  append_trace(chain, tree, plan);
  TraceCounters counters{};
  counters.rays.x = 1000;
  counters.hits.x = 250;
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts_of_trace(counters));
  }
  EXPECT_EQ(bytes["shade_pixels"], 1000u * 8 + 250 * 64);
  EXPECT_FALSE(bytes.contains("shade") || bytes.contains("resolve"));
}

// 1,000 rays, of which 250 hit something; of the 200 shadow rays of two lights 40 are blocked.
TEST(Traffic, OfLightsAndShadows) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  const TracePlan plan =
      plan_trace(layout, tree, 1, {.width = 40, .height = 25, .lights = {.lights = 3, .shadows = 2}});
  Chain chain(no_addresses);
  append_trace(chain, tree, plan);
  RunCounts counts;
  counts.rays = 1000, counts.hits = 250, counts.steps = 4000;
  counts.shadow = {2000, 200, 40, 3000};
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts);
  }
  EXPECT_EQ(bytes["shadow_marks"], 2u * (1000 * 20 + 250 * 76));
  EXPECT_EQ(bytes["shadow_rays"], 2u * 1000 * 8 + 200 * 96);
  EXPECT_EQ(bytes["trace_any"], 200u * 36 + 3000 * 64 + 40 * 36);
  const std::uint64_t plain = 1000 * 4 + 250 * 112;
  EXPECT_EQ(bytes["shade_lights"], plain + 2 * (1000 * 4 + 250 * 4) + 200 * 8 + 160 * 112);
}

TEST(Traffic, OfATraceOfTwoSamples) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  TraceOptions options;
  options.width = 40;
  options.height = 25;
  options.samples = 2;
  const TracePlan plan = plan_trace(layout, tree, 1, options);
  Chain chain(no_addresses);
  append_trace(chain, tree, plan);
  append_bounce(chain, tree, plan, plan, 1000, 1);
  TraceCounters counters{};
  counters.rays.x = 2000;
  counters.hits.x = 500;
  counters.steps = {30000, 1};
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts_of_trace(counters));
  }
  EXPECT_EQ(bytes["camera_rays"], 2000u * 48);
  EXPECT_EQ(bytes["trace_closest"], 2000u * 64 + 64 * ((std::uint64_t{1} << 32) + 30000) + 500 * 36);
  EXPECT_EQ(bytes["shade"], 2000u * 48 + 500 * 64 + 1000 * 12);
  EXPECT_EQ(bytes["resolve"], 16000u);
  EXPECT_EQ(bytes["bounce_rays"], 1000u * 96 + 250 * 36);
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

TEST(Traffic, OfAnyHitsAndCandidates) {
  Layout layout;
  TreeSlots tree = plan_tree(layout, 100, 199);
  plan_wide(layout, tree);
  AnyHitSlots any = plan_any_hits(layout, 1000);
  const CandidateSlots candidates = plan_candidates(layout, 1000, 4);
  TraceCounters counters{};
  counters.rays.x = 1000;
  counters.hits.x = 500;
  counters.steps.x = 30000;
  Chain chain(no_addresses);
  TraceOptions options;
  append_any_hits(chain, tree, any, 1000, options);
  options.walk = Walk::wide_single;
  append_any_hits(chain, tree, any, 1000, options);
  append_candidates(chain, tree, candidates, 1000, options);
  const auto bytes = [&](std::size_t step) {
    return modelled_bytes(chain.steps()[step], counts_of_trace(counters));
  };
  EXPECT_EQ(bytes(0), 1000u * 36 + 30000 * 64 + 500 * 36);
  EXPECT_EQ(bytes(1), 1000u * 36 + 30000 * 96 + 500 * 36);
  EXPECT_EQ(bytes(2), 1000u * 36 + 30000 * 64 + 500 * 8);
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
