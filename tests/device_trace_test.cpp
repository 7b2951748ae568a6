// Rays on the device find what the independent CPU tracer finds, and what brute force finds, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "analysis/compare.h"
#include "analysis/cpu_tracer.h"
#include "builders/ploc.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/errors.h"
#include "support/device_run.h"

namespace coppice {
namespace {

class DeviceTrace : public DeviceTest {};

constexpr float infinity = std::numeric_limits<float>::infinity();

std::vector<Ray> random_rays(std::uint32_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto next = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray = {vec3(next(), next(), next()) * 3.0f - 1.0f, 0, vec3(next(), next(), next()) - 0.5f, infinity};
  }
  return rays;
}

std::size_t hit_count(const std::vector<Hit>& hits) {
  return std::ranges::count_if(hits, [](const Hit& hit) { return hit.triangle != NO_TRIANGLE; });
}

TEST_F(DeviceTrace, TreeAndBruteForceGiveTheSameHits) {
  const std::vector<Triangle> triangles = random_triangles(20000, 1, 0.1f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = random_rays(5000, 2);
  const TracedRays tree = trace_on_device(bvh.nodes, triangles, rays);
  const TracedRays brute = trace_on_device({}, triangles, rays);
  EXPECT_EQ(tree.error_word, 0u);
  EXPECT_EQ(compare_hits(tree.hits, brute.hits).count, 0u);
  EXPECT_GT(hit_count(tree.hits), 500u);
}

TEST_F(DeviceTrace, AgreesWithTheCpuTracerButForEdges) {
  const std::vector<Triangle> triangles = random_triangles(20000, 3, 0.1f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = random_rays(20000, 4);
  const TracedRays device = trace_on_device(bvh.nodes, triangles, rays);
  std::vector<Hit> cpu(rays.size());
  trace_all(bvh.nodes, triangles, rays, cpu);
  const HitDifference difference = compare_hits(device.hits, cpu);
  EXPECT_LE(difference.other_triangle, rays.size() / 1000);
}

// A plane of triangles at z = 0 seen along the axes, and rays that run in the plane of a box.
TEST_F(DeviceTrace, DirectionsWithZeroAndNegativeZeroComponents) {
  const auto triangles = scene_arrays(find_hard_case("planar-grid")->make(2048, 1)).triangles;
  const Bvh bvh = build_ploc(triangles, {});
  const Aabb box{bvh.nodes[0].box_min, bvh.nodes[0].box_max};
  const vec3 size = box.box_max - box.box_min;
  const int flat = size.x == 0 ? 0 : size.y == 0 ? 1 : 2;
  std::vector<Ray> rays;
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    vec3 origin =
        box.box_min + size * vec3(random() % 997 / 997.0f, random() % 997 / 997.0f, random() % 997 / 997.0f);
    for (const float zero : {0.0f, -0.0f}) {
      for (const float sign : {1.0f, -1.0f}) {
        vec3 direction(zero);
        direction[flat] = sign;
        origin[flat] = box.box_min[flat] - sign;
        rays.push_back({origin, 0, direction, infinity});
      }
    }
  }
  const TracedRays tree = trace_on_device(bvh.nodes, triangles, rays);
  EXPECT_EQ(hit_count(tree.hits), rays.size());
  EXPECT_EQ(compare_hits(tree.hits, trace_on_device({}, triangles, rays).hits).count, 0u);
}

TEST_F(DeviceTrace, UnsoundRaysMiss) {
  const std::vector<Triangle> triangles = random_triangles(1000, 3, 1.0f);
  const Bvh bvh = build_ploc(triangles, {});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Ray> rays = {{vec3(nan, 0, 0), 0, vec3(1, 0, 0), infinity},
                                 {vec3(0.5f), 0, vec3(1, nan, 0), infinity},
                                 {vec3(0.5f), 0, vec3(0), infinity},
                                 {vec3(0.5f), 2, vec3(1, 0, 0), 1}};
  EXPECT_EQ(hit_count(trace_on_device(bvh.nodes, triangles, rays).hits), 0u);
}

TEST_F(DeviceTrace, OfCoincidentTrianglesTheFirstIsHit) {
  const auto triangles = scene_arrays(find_hard_case("coincident")->make(100000, 1)).triangles;
  const BuiltTree tree = build_on(test_device(), triangles, {});
  const Triangle& t = triangles[0];
  const vec3 centre = (t.a + t.b + t.c) / 3.0f;
  const vec3 u = t.b - t.a, v = t.c - t.a;
  const vec3 normal(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  const std::vector<Ray> rays = {{centre + normal, 0, -normal, infinity},
                                 {centre + normal, 0, normal, infinity}};
  TraceOptions options = test_trace_options(1, 1);
  options.visits_per_turn = 2;
  const TracedRays traced = trace_on_device(tree.nodes, triangles, rays, options);
  EXPECT_EQ(traced.error_word, 0u) << describe_error_word(traced.error_word);
  EXPECT_EQ(traced.hits[0].triangle, 0u);
  EXPECT_EQ(traced.hits[1].triangle, NO_TRIANGLE);
}

TEST_F(DeviceTrace, InARowOfShrinkingGapsEachIsHit) {
  const auto triangles = scene_arrays(find_hard_case("shrinking-gaps")->make(1000000, 1)).triangles;
  const BuiltTree tree = build_on(test_device(), triangles, {});
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < triangles.size(); i += 999) {
    const Triangle& t = triangles[i];
    const vec3 u = t.b - t.a, v = t.c - t.a;
    const vec3 normal(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
    rays.push_back({t.a * 0.25f + t.b * 0.25f + t.c * 0.5f + normal, 0, -normal, infinity});
  }
  const TracedRays traced = trace_on_device(tree.nodes, triangles, rays);
  EXPECT_EQ(traced.error_word, 0u);
  EXPECT_EQ(hit_count(traced.hits), rays.size());
  std::vector<Hit> cpu(rays.size());
  trace_all(tree.nodes, triangles, rays, cpu);
  EXPECT_EQ(compare_hits(traced.hits, cpu).other_triangle, 0u);
}

TEST_F(DeviceTrace, TooFewTurnsAreReportedByName) {
  const std::vector<Triangle> triangles = random_triangles(2000, 3, 0.5f);
  TraceOptions options = test_trace_options(1, 1);
  options.max_turns = 5;
  const TracedRays traced =
      trace_on_device(build_ploc(triangles, {}).nodes, triangles, random_rays(100, 1), options);
  EXPECT_NE(describe_error_word(traced.error_word).find("trace_closest"), std::string::npos);
}

// A tree like a ladder: each internal node has one leaf and the rest of the ladder.
std::vector<Node> ladder(std::span<const Triangle> triangles) {
  std::vector<Node> nodes;
  const Bvh leaves = build_ploc(triangles, {});
  Aabb box{leaves.nodes[0].box_min, leaves.nodes[0].box_max};
  const auto count = static_cast<uint>(triangles.size());
  nodes.push_back({box.box_min, 1, box.box_max, count - 1});
  for (uint i = 0; i + 1 < count; ++i) {
    const bool last = i + 2 == count;
    nodes.push_back({box.box_min, i, box.box_max, 0});
    nodes.push_back({box.box_min, last ? count - 1 : 2 * i + 3, box.box_max, count - 2 - i});
  }
  return nodes;
}

TEST_F(DeviceTrace, ATreeAsDeepAsTheStackIsTracedAndOneDeeperIsRefused) {
  const std::vector<Triangle> triangles = random_triangles(TRACE_STACK_LIMIT + 2, 4, 0.5f);
  const std::vector<Ray> rays = random_rays(500, 5);
  const auto fits = std::span(triangles).first(TRACE_STACK_LIMIT + 1);
  const TracedRays deep = trace_on_device(ladder(fits), fits, rays);
  EXPECT_EQ(deep.error_word, 0u);
  EXPECT_EQ(compare_hits(deep.hits, trace_on_device({}, fits, rays).hits).count, 0u);
  EXPECT_EQ(trace_on_device(ladder(triangles), triangles, rays).error_word, ERROR_TREE_TOO_DEEP);
}

}  // namespace
}  // namespace coppice
