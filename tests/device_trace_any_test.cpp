// Any hits are what closest hits say there is, what exact arithmetic allows, and what masks and flags leave;
// by kernel and twin alike, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "analysis/hard_rays.h"
#include "analysis/judge_hits.h"
#include "builders/ploc.h"
#include "measure/traffic.h"
#include "render/scene_arrays.h"
#include "scene/hard_cases.h"
#include "stages/errors.h"
#include "support/device_run.h"
#include "support/floor.h"
#include "support/lockstep.h"
#include "support/traced.h"

namespace coppice {
namespace {

class TraceAny : public DeviceTest, public testing::WithParamInterface<Walk> {
 protected:
  static TraceOptions options() {
    TraceOptions options = test_trace_options(1, 1);
    options.walk = GetParam();
    options.max_turns = std::min(options.max_turns, 1u << 20);  // a walk that does not end fails
    return options;
  }

  static TracedBoth trace(const RaysToTrace& input) { return trace_in_lockstep(input, options()); }
};

// How many rays hit.
std::size_t expect_any_is_closest(const TracedBoth& traced, const std::string& what) {
  EXPECT_EQ(traced.error_word, 0u) << what << ": " << describe_error_word(traced.error_word);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < traced.hits.size(); ++i) {
    hits += has_hit(traced.hits[i]);
    EXPECT_EQ(traced.any_hits[i], has_hit(traced.hits[i]) ? 1u : 0u) << what << ", ray " << i;
  }
  EXPECT_EQ(traced.any_counters.hits.x, hits) << what;
  EXPECT_EQ(traced.any_counters.rays.x, traced.hits.size()) << what;
  return hits;
}

std::vector<Ray> rays_of_all_kinds(std::span<const Triangle> triangles, std::span<const Node> nodes,
                                   std::uint32_t count) {
  std::vector<Ray> rays;
  for (const RayKindName& kind : ray_kinds()) {
    const std::vector<Ray> more = hard_rays(kind.kind, triangles, nodes, count, 1);
    rays.insert(rays.end(), more.begin(), more.end());
  }
  return rays;
}

// A ray that certainly hits is not said to miss, and one that certainly misses not to hit: where an any hit
// says that there is one, the closest hit is it.
TEST_P(TraceAny, HardRaysAtHardCasesAndTheReferee) {
  std::size_t hits = 0;
  for (const std::string_view name : hard_case_names()) {
    Scene scene = find_hard_case(std::string(name))->make(500, 1);
    bring_into_range(scene);
    const std::vector<Triangle> triangles = scene_arrays(scene).triangles;
    const Bvh bvh = build_ploc(triangles, {});
    const std::vector<Ray> rays = rays_of_all_kinds(triangles, bvh.nodes, 70);
    const RaysToTrace input{.nodes = bvh.nodes, .triangles = triangles, .rays = rays};
    const TracedBoth traced = is_wide(GetParam()) ? trace_on_both(input, options()) : trace(input);
    hits += expect_any_is_closest(traced, std::string(name));
    std::vector<Hit> claimed = traced.hits;
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (traced.any_hits[i] == 0) claimed[i].triangle = NO_TRIANGLE;
    const HitVerdicts verdicts = judge_hits(bvh.nodes, triangles, rays, claimed);
    EXPECT_EQ(verdicts.missed, 0u) << name << ", ray " << verdicts.example_missed;
    EXPECT_EQ(verdicts.false_hits, 0u) << name << ", ray " << verdicts.example_false;
  }
  EXPECT_GT(hits, 5000u);
}

TEST_P(TraceAny, FewRaysAndFewTriangles) {
  for (std::uint32_t count = 0; count <= 20; ++count) {
    const std::vector<Triangle> triangles = random_triangles(count, count, 0.5f);
    const Bvh bvh = build_ploc(triangles, {});
    const std::vector<Ray> rays = hard_rays(RayKind::VERTICES, triangles, {}, 130, count);
    for (const std::size_t ray_count : {0, 1, 63, 64, 65, 127, 128, 129}) {
      const TracedBoth traced =
          trace({.nodes = bvh.nodes, .triangles = triangles, .rays = std::span(rays).first(ray_count)});
      expect_any_is_closest(traced, std::to_string(count) + " triangles");
    }
  }
}

TEST_P(TraceAny, ShortRaysAndRaysFromBehind) {
  const std::vector<Triangle> triangles = random_triangles(5000, 3, 0.1f);
  std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 2000, 4);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].t_max = static_cast<float>(i % 10) * 0.1f;
    if (i % 3 == 0) rays[i].t_min = -0.3f;
    if (i % 5 == 0) rays[i].t_min = -INFINITE;
  }
  const Bvh bvh = build_ploc(triangles, {});
  const TracedBoth traced = trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays});
  const std::size_t hits = expect_any_is_closest(traced, "short rays");
  EXPECT_GT(hits, 500u);
  EXPECT_LT(hits, 1900u);
}

// The first hit ends a ray: it visits less than the closest hit takes.
TEST_P(TraceAny, EndsAtTheFirstHit) {
  const std::vector<Triangle> triangles = random_triangles(20000, 3, 0.1f);
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 1000, 4);
  const Bvh bvh = build_ploc(triangles, {});
  const TracedBoth traced = trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays});
  EXPECT_GT(expect_any_is_closest(traced, "many triangles"), 500u);
  EXPECT_LT(traced.any_counters.steps.x, traced.hit_counters.steps.x);
}

TEST_P(TraceAny, UnsoundRaysAndRaysBeyondTheRangeOfFloat) {
  const std::vector<Triangle> triangles = {FLOOR};
  const Bvh bvh = build_ploc(triangles, {});
  const vec3 down(0, 0, -1), above(0.25f, 0.25f, 1);
  const std::vector<Ray> rays = {{vec3(NOT_A_NUMBER, 0, 0), 0, down, INFINITE},
                                 {above, 0, vec3(NOT_A_NUMBER, 0, -1), INFINITE},
                                 {above, NOT_A_NUMBER, down, INFINITE},
                                 {above, 0, down, NOT_A_NUMBER},
                                 {vec3(INFINITE, 0, 1), 0, down, INFINITE},
                                 {above, 0, vec3(0, 0, -INFINITE), INFINITE},
                                 {above, 0, vec3(0), INFINITE},
                                 {above, 2, down, 1},
                                 {above * vec3(1, 1, 8), 0, down * 0x1p-126f, INFINITE},  // t would be 2^129
                                 {above, 0, down * 0x1p-126f, INFINITE},
                                 {above, 0, down, INFINITE}};
  const TracedBoth traced = trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays});
  expect_any_is_closest(traced, "unsound rays");
  EXPECT_EQ(traced.any_hits, (std::vector<uint>{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1}));
}

TEST_P(TraceAny, EndsOfTheRangeCount) {
  const std::vector<Triangle> triangles = {FLOOR};
  const Bvh bvh = build_ploc(triangles, {});
  const float before = std::nextafter(1.0f, 0.0f), behind = std::nextafter(1.0f, 2.0f);
  std::vector<Ray> rays(4, down_at(0.25f, 0.25f));
  rays[0].t_max = 1;
  rays[1].t_max = before;
  rays[2].t_min = 1;
  rays[3].t_min = behind;
  const TracedBoth traced = trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays});
  EXPECT_EQ(traced.any_hits, (std::vector<uint>{1, 0, 1, 0}));
}

TEST_P(TraceAny, NothingIsHitInNoTree) {
  const std::vector<Ray> rays(100, down_at(0.25f, 0.25f));
  const TracedBoth traced = trace({.nodes = {}, .triangles = {}, .rays = rays});
  EXPECT_EQ(traced.any_hits, std::vector<uint>(100, 0u));
  EXPECT_EQ(expect_any_is_closest(traced, "no tree"), 0u);
}

// --- Masks and flags.

// What rays hit of some triangles of a scene alone; indices are those of the scene.
std::vector<Hit> hits_of_part(std::span<const Triangle> triangles, std::span<const Ray> rays,
                              const std::function<bool(uint)>& is_part) {
  std::vector<Triangle> part;
  std::vector<uint> index;
  for (uint k = 0; k < triangles.size(); ++k) {
    if (!is_part(k)) continue;
    part.push_back(triangles[k]);
    index.push_back(k);
  }
  if (part.empty()) return std::vector<Hit>(rays.size(), MISS);
  std::vector<Hit> hits = trace_on_device({}, part, rays).hits;
  for (Hit& hit : hits)
    if (has_hit(hit)) hit.triangle = index[hit.triangle];
  return hits;
}

// With a mask and a flag by random for each primitive, and one of a few masks a ray.
TEST_P(TraceAny, MasksAndFlagsAreTheSceneWithoutWhatIsNotSeen) {
  const std::vector<Triangle> triangles = random_triangles(3000, 3, 0.2f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 2000, 4);
  std::mt19937 random(1);
  std::vector<uint> flags(triangles.size()), masks(rays.size());
  for (uint& word : flags) word = (1u << random() % 8) | (random() % 3 == 0 ? PRIMITIVE_NOT_OPAQUE : 0u);
  const uint ray_mask = 0xfffffe7fu, some[] = {0, 0x1, 0x80, 0x3, 0x1ff, 0xff00, 0xffffffff};
  for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = some[i % std::size(some)];
  for (const bool masks_a_ray : {true, false}) {
    const TracedBoth traced = trace({.nodes = bvh.nodes,
                                     .triangles = triangles,
                                     .rays = rays,
                                     .primitive_flags = flags,
                                     .ray_masks = masks_a_ray ? masks : std::vector<uint>{},
                                     .ray_mask = ray_mask});
    EXPECT_EQ(traced.error_word, 0u);
    std::size_t hits = 0;
    for (const uint mask : some) {
      const uint both = masks_a_ray ? mask & ray_mask : ray_mask;
      const auto seen = [&](uint k) { return (flags[k] & both & 0xff) != 0; };
      const auto opaque = [&](uint k) { return seen(k) && (flags[k] & PRIMITIVE_NOT_OPAQUE) == 0; };
      const std::vector<Hit> closest = hits_of_part(triangles, rays, seen);
      const std::vector<Hit> ends = hits_of_part(triangles, rays, opaque);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (masks[i] != mask) continue;
        EXPECT_EQ(traced.hits[i].triangle, closest[i].triangle) << "mask " << mask << ", ray " << i;
        EXPECT_EQ(traced.any_hits[i], has_hit(ends[i]) ? 1u : 0u) << "mask " << mask << ", ray " << i;
        hits += traced.any_hits[i];
      }
    }
    EXPECT_GT(hits, 300u);
    EXPECT_LT(hits, 1900u);
  }
}

TEST_P(TraceAny, AMaskOfNothingSeesNothing) {
  const std::vector<Triangle> triangles = {FLOOR};
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays(70, down_at(0.25f, 0.25f));
  for (const uint mask : {0u, 0xffffff00u}) {
    const TracedBoth traced =
        trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays, .ray_mask = mask});
    EXPECT_EQ(expect_any_is_closest(traced, "mask of nothing"), 0u);
  }
}

TEST_P(TraceAny, WhatIsNotOpaqueEndsNoRayAndIsHitClosest) {
  const std::vector<Triangle> triangles = {FLOOR, {FLOOR.a - vec3(0, 0, 1), FLOOR.b, FLOOR.c}};
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = {down_at(0.25f, 0.25f), down_at(0.25f, 0.25f, -0.1f)};
  const auto traced_with = [&](uint upper, uint lower) {
    return trace(
        {.nodes = bvh.nodes, .triangles = triangles, .rays = rays, .primitive_flags = {upper, lower}});
  };
  const TracedBoth none = traced_with(PRIMITIVE_NOT_OPAQUE | 1, PRIMITIVE_NOT_OPAQUE | 1);
  EXPECT_EQ(none.any_hits, (std::vector<uint>{0, 0}));
  EXPECT_EQ(none.hits[0].triangle, 0u);
  EXPECT_EQ(none.hits[1].triangle, 1u);
  EXPECT_EQ(traced_with(PRIMITIVE_NOT_OPAQUE | 1, 1).any_hits, (std::vector<uint>{1, 1}));
  EXPECT_EQ(traced_with(1, PRIMITIVE_NOT_OPAQUE | 1).any_hits, (std::vector<uint>{1, 0}));
}

// The only opaque one of many triangles in the same place.
TEST_P(TraceAny, OneOfManyInOnePlace) {
  const std::vector<Triangle> triangles(1000, FLOOR);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays(20, down_at(0.25f, 0.25f));
  for (const std::size_t opaque : {0, 1, 500, 999, 1000}) {
    std::vector<uint> flags(triangles.size(), PRIMITIVE_FLAGS_DEFAULT | PRIMITIVE_NOT_OPAQUE);
    if (opaque < flags.size()) flags[opaque] = PRIMITIVE_FLAGS_DEFAULT;
    const TracedBoth traced =
        trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays, .primitive_flags = flags});
    EXPECT_EQ(traced.any_hits, std::vector<uint>(20, opaque < 1000 ? 1u : 0u)) << opaque;
    EXPECT_EQ(traced.hits[0].triangle, 0u);
  }
}

// --- Counts on the device.

TEST_P(TraceAny, ACountOnTheDeviceIsKeptTo) {
  const std::vector<Triangle> triangles = random_triangles(500, 3, 0.3f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 300, 4);
  const TracedBoth all = trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays});
  for (const uint count : {0u, 1u, 7u, 64u, 127u, 128u, 129u, 299u, 300u, 301u, 4096u, 0xffffffffu}) {
    const TracedBoth some = trace({.nodes = bvh.nodes, .triangles = triangles, .rays = rays, .count = count});
    const std::size_t counted = std::min<std::size_t>(count, rays.size());
    EXPECT_EQ(some.any_counters.rays.x, counted);
    EXPECT_EQ(some.hit_counters.rays.x, counted);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(some.any_hits[i], i < counted ? all.any_hits[i] : UNTOUCHED) << count << ", ray " << i;
      EXPECT_EQ(some.hits[i].triangle, i < counted ? all.hits[i].triangle : UNTOUCHED)
          << count << ", ray " << i;
    }
  }
}

TEST_P(TraceAny, TooFewTurnsAreReportedByName) {
  const std::vector<Triangle> triangles = random_triangles(5000, 3, 0.1f);
  const std::vector<Ray> rays = hard_rays(RayKind::VERTICES, triangles, {}, 100, 4);
  Layout layout(test_device().properties().max_block_bytes);
  const Bvh bvh = build_ploc(triangles, {});
  TreeSlots tree = plan_tree(layout, 5000, bvh.nodes.size());
  const WidePlan wide = plan_wide(layout, tree);
  const AnyHitSlots slots = plan_any_hits(layout, 100);
  GpuExecutor executor(test_device(), layout);
  BuildState state{};
  state.active_count = 5000;
  executor.upload(tree.nodes, std::span<const Node>(bvh.nodes));
  executor.upload(tree.triangles, std::span<const Triangle>(triangles));
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));
  executor.upload(slots.rays, std::span<const Ray>(rays));
  TraceOptions few = options();
  few.max_turns = 3;
  Chain chain = executor.chain();
  append_wide(chain, tree, wide);
  append_any_hits(chain, tree, slots, 100, few);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  EXPECT_EQ(executor.read(tree.state)[0].error_word, ERROR_TRACE_STEPS);
  EXPECT_NE(describe_error_word(ERROR_TRACE_STEPS).find("trace_any"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Trees, TraceAny, testing::Values(Walk::binary, Walk::wide_single),
                         [](const auto& info) { return is_wide(info.param) ? "Wide" : "Binary"; });

// --- Of the binary tree only.

class TraceAnyBinary : public DeviceTest {};

// These may lose hits, but the any hit goes the same way as the closest one up to its first hit.
TEST_F(TraceAnyBinary, ByEveryTest) {
  const std::vector<Triangle> triangles = random_triangles(5000, 3, 0.1f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = rays_of_all_kinds(triangles, bvh.nodes, 100);
  for (const std::uint32_t triangle_test : {TRIANGLE_FAST, TRIANGLE_WATERTIGHT}) {
    for (const std::uint32_t box_test : {BOX_FAST, BOX_ROBUST}) {
      for (const std::uint32_t visits : {1u, 2u}) {
        TraceOptions options = test_trace_options(1, 1);
        options.triangle_test = triangle_test;
        options.box_test = box_test;
        options.visits_per_turn = visits;
        const TracedBoth traced =
            trace_in_lockstep({.nodes = bvh.nodes, .triangles = triangles, .rays = rays}, options);
        EXPECT_GT(expect_any_is_closest(traced, "tests"), 500u);
      }
    }
  }
}

TEST_F(TraceAnyBinary, ATreeDeeperThanTheStackIsRefusedAndNothingIsHit) {
  const std::vector<Triangle> triangles = random_triangles(1000, 3, 0.1f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 100, 4);
  TraceOptions options = test_trace_options(1, 1);
  options.stack_entries = bvh.nodes[0].height;
  const RaysToTrace input{.nodes = bvh.nodes, .triangles = triangles, .rays = rays};
  expect_any_is_closest(trace_in_lockstep(input, options), "as deep as the stack");
  --options.stack_entries;
  const TracedBoth traced = trace_in_lockstep(input, options);
  EXPECT_EQ(traced.error_word, ERROR_TREE_TOO_DEEP);
  EXPECT_EQ(traced.any_hits, std::vector<uint>(100, 0));
}

TEST_F(TraceAnyBinary, WhatCannotBeTracedIsRefused) {
  Layout layout;
  TreeSlots tree = plan_tree(layout, 1, 1);
  plan_wide(layout, tree);
  const AnyHitSlots slots = plan_any_hits(layout, 10);
  const std::uint64_t address[] = {0};
  Chain chain(address);
  TraceOptions options = test_trace_options(1, 1);
  EXPECT_THROW(append_any_hits(chain, tree, slots, 11, options), LayoutError);
  options.walk = Walk::wide_single;
  options.box_test = BOX_FAST;
  EXPECT_THROW(append_any_hits(chain, tree, slots, 10, options), std::invalid_argument);
  options.walk = Walk::brute_force;
  EXPECT_THROW(append_any_hits(chain, tree, slots, 10, options), std::invalid_argument);
  RaySlots closest{slots.rays, layout.add<Hit>("hits", 10), slots.counters, {}};
  closest.filter.ray_mask = 0;
  EXPECT_THROW(append_closest_hits(chain, tree, closest, 10, options), std::invalid_argument);
  options.walk = Walk::binary;
  closest.filter.count_at = layout.add<uint>("count", 1);
  RayRange second{RANGE_RAYS, 1};
  EXPECT_THROW(append_closest_hits(chain, tree, closest, second, options, 1), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
