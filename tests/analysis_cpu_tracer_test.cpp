#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "analysis/cpu_tracer.h"
#include "builders/ploc.h"
#include "scene/random.h"
#include "support/floor.h"

namespace coppice {
namespace {

bool same_bits(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof(Hit)) == 0; }

void expect_miss(const Ray& ray, const std::vector<Triangle>& triangles = {FLOOR}) {
  for (const Hit& hit :
       {brute_force_hit(triangles, ray), closest_hit(build_ploc(triangles).nodes, triangles, ray)}) {
    EXPECT_EQ(hit.triangle, NO_TRIANGLE);
    EXPECT_TRUE(hit.t == ray.t_max || std::isnan(ray.t_max));
  }
}

// A scene of triangles and rays, for the tracers to agree on.
struct TracedScene {
  const char* name;
  float unit;           // of length
  vec3 offset;          // of the scene from the origin, in units
  float triangle_size;  // in units
  std::uint32_t cells;  // corners on a grid of this many cells to the unit, so that ties abound; 0: anywhere
  bool axis_aligned;    // rays along an axis, with zeros of both signs
};

void PrintTo(const TracedScene& scene, std::ostream* out) { *out << scene.name; }

class TracersAgree : public testing::TestWithParam<TracedScene> {
 protected:
  vec3 point(Random& random, float extent) const {
    vec3 p = random.in_cube() * extent;
    if (const auto cells = static_cast<float>(GetParam().cells); cells > 0) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * cells) / cells;
    }
    return p;
  }
  vec3 in_world(const vec3& p) const { return (p + GetParam().offset) * GetParam().unit; }

  std::vector<Triangle> make_triangles(Random& random) const {
    std::vector<Triangle> triangles;
    for (int i = 0; i < 300; ++i) {
      const vec3 a = point(random, 1.0f);
      const vec3 b = a + point(random, GetParam().triangle_size);
      const vec3 c = a + point(random, GetParam().triangle_size);
      triangles.push_back({in_world(a), in_world(b), in_world(c)});
    }
    return triangles;
  }

  Ray make_ray(Random& random) const {
    const vec3 origin = point(random, 2.0f);
    vec3 direction = point(random, 1.0f) - origin;
    if (GetParam().axis_aligned) {
      const std::uint32_t axis = random.below(3);
      const float sign = random.below(2) == 0 ? -1.0f : 1.0f;
      direction = vec3(random.below(2) == 0 ? -0.0f : 0.0f);
      direction[static_cast<int>(axis)] = sign;
    }
    return ray_from(in_world(origin), direction * GetParam().unit);
  }
};

TEST_P(TracersAgree, WithBruteForceToTheBit) {
  Random random(11);
  const std::vector<Triangle> triangles = make_triangles(random);
  const std::vector<Node> nodes = build_ploc(triangles).nodes;
  int hit_count = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = make_ray(random);
    const Hit expected = brute_force_hit(triangles, ray);
    const Hit hit = closest_hit(nodes, triangles, ray);
    ASSERT_TRUE(same_bits(hit, expected)) << "ray " << i << ": triangle " << hit.triangle << " at " << hit.t
                                          << ", not " << expected.triangle << " at " << expected.t;
    hit_count += hit.triangle != NO_TRIANGLE;
  }
  EXPECT_GT(hit_count, 100);
}

INSTANTIATE_TEST_SUITE_P(Scenes, TracersAgree,
                         testing::Values(TracedScene{"plain", 1, vec3(0), 0.5f, 0, false},
                                         TracedScene{"large", 1, vec3(0), 3, 0, false},
                                         TracedScene{"ties", 1, vec3(0), 1, 4, false},
                                         TracedScene{"ties_along_axes", 1, vec3(0), 1, 4, true},
                                         TracedScene{"along_axes", 1, vec3(0), 0.5f, 0, true},
                                         TracedScene{"far_away", 1, vec3(148376, 1234, -223423), 0.5f, 0,
                                                     false},
                                         TracedScene{"microscopic", 1e-30f, vec3(0), 0.5f, 0, false},
                                         TracedScene{"astronomic", 1e30f, vec3(0), 0.5f, 0, false}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(BruteForceHit, FindsDistanceAndBarycentricCoordinates) {
  const Hit hit =
      brute_force_hit(std::vector<Triangle>{FLOOR}, ray_from(vec3(0.5f, 0.25f, 3), vec3(0, 0, -2)));
  EXPECT_EQ(hit.triangle, 0u);
  EXPECT_EQ(hit.t, 1.5f);
  EXPECT_EQ(hit.u, 0.5f);
  EXPECT_EQ(hit.v, 0.25f);
}

TEST(BruteForceHit, SeesBothSides) {
  const Hit hit =
      brute_force_hit(std::vector<Triangle>{FLOOR}, ray_from(vec3(0.5f, 0.25f, -3), vec3(0, 0, 2)));
  EXPECT_EQ(hit.triangle, 0u);
  EXPECT_EQ(hit.u, 0.5f);
  EXPECT_EQ(hit.v, 0.25f);
}

TEST(BruteForceHit, ChoosesTheSmallestIndexOfEqualDistances) {
  const std::vector<Triangle> triangles(5, FLOOR);
  const Ray ray = ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1));
  EXPECT_EQ(brute_force_hit(triangles, ray).triangle, 0u);
  EXPECT_EQ(closest_hit(build_ploc(triangles).nodes, triangles, ray).triangle, 0u);
}

TEST(BruteForceHit, IncludesBothEndsOfTheRay) {
  const std::vector<Triangle> triangles = {FLOOR};
  EXPECT_EQ(brute_force_hit(triangles, {vec3(0.25f, 0.25f, 1), 1, vec3(0, 0, -1), 2}).triangle, 0u);
  EXPECT_EQ(brute_force_hit(triangles, {vec3(0.25f, 0.25f, 1), 0, vec3(0, 0, -1), 1}).triangle, 0u);
}

TEST(BruteForceHit, MissesBeyondTheEndsOfTheRay) {
  expect_miss({vec3(0.25f, 0.25f, 1), std::nextafter(1.0f, 2.0f), vec3(0, 0, -1), 2});
  expect_miss({vec3(0.25f, 0.25f, 1), 0, vec3(0, 0, -1), std::nextafter(1.0f, 0.0f)});
}

TEST(BruteForceHit, LeavesNoGapAtASharedEdgeOrVertex) {
  // A fan around the origin, which rays hit exactly at its spokes and its centre.
  Random random(5);
  const std::vector<vec3> rim = {vec3(1, 0, 0.1f), vec3(0.3f, 0.9f, 0), vec3(-0.8f, 0.5f, 0.2f),
                                 vec3(-0.6f, -0.7f, 0), vec3(0.4f, -1, 0.3f)};
  std::vector<Triangle> fan;
  for (std::size_t i = 0; i < rim.size(); ++i) fan.push_back({vec3(0), rim[i], rim[(i + 1) % rim.size()]});
  for (int i = 0; i < 2000; ++i) {
    vec3 origin = random.in_cube();
    origin.z = 5;
    const vec3 target = rim[random.below(5)] * (i % 4 == 0 ? 0.0f : random.uniform() * 0.5f);
    EXPECT_NE(brute_force_hit(fan, ray_from(origin, target - origin)).triangle, NO_TRIANGLE) << i;
  }
}

TEST(BruteForceHit, MissesTrianglesWithoutArea) {
  const std::vector<Triangle> degenerate = {{vec3(0.25f), vec3(0.25f), vec3(0.25f)},
                                            {vec3(0), vec3(0.5f), vec3(1)},
                                            {vec3(0), vec3(1, 0, 0), vec3(1, 0, 0)}};
  expect_miss(ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1)), degenerate);
  expect_miss(ray_from(vec3(0.25f, 0, 1), vec3(0, 0, -1)), degenerate);
  expect_miss(ray_from(vec3(-1, 0, 0), vec3(1, 0, 0)), degenerate);
}

TEST(BruteForceHit, MissesATriangleEdgeOn) { expect_miss(ray_from(vec3(-1, 0.25f, 0), vec3(1, 0, 0))); }

TEST(BruteForceHit, MissesInactiveTriangles) {
  Triangle inactive = FLOOR;
  inactive.c.y = INFINITE;
  expect_miss(ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1)), {inactive});
}

TEST(BruteForceHit, MissesWithRaysThatAreNone) {
  for (const float odd : {NOT_A_NUMBER, INFINITE, -INFINITE}) {
    for (int axis = 0; axis < 3; ++axis) {
      Ray ray = ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1));
      ray.origin[axis] = odd;
      expect_miss(ray);
      ray = ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1));
      ray.direction[axis] = odd;
      expect_miss(ray);
    }
  }
  expect_miss(ray_from(vec3(0.25f, 0.25f, 0), vec3(0)));
  expect_miss({vec3(0.25f, 0.25f, 1), NOT_A_NUMBER, vec3(0, 0, -1), INFINITE});
  expect_miss({vec3(0.25f, 0.25f, 1), 0, vec3(0, 0, -1), NOT_A_NUMBER});
}

TEST(BruteForceHit, MissesWithDirectionsWhoseComponentsAreAllDenormal) {
  expect_miss(ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1e-38f)));
  expect_miss(ray_from(vec3(0.25f, 0.25f, 1e-3f), vec3(1e-40f, -1e-45f, -1.1e-38f)));
}

// Beside a component of 2e-38 one of 1e-38 would lead far off.
TEST(BruteForceHit, TakesADenormalDirectionComponentForZero) {
  const Ray ray = ray_from(vec3(0.25f, 0.125f, 1), vec3(1e-38f, -1e-38f, -2e-38f));
  const std::vector<Triangle> triangles = {FLOOR};
  for (const Hit& hit :
       {brute_force_hit(triangles, ray), closest_hit(build_ploc(triangles).nodes, triangles, ray)}) {
    EXPECT_EQ(hit.triangle, 0u);
    EXPECT_EQ(hit.u, 0.25f);
    EXPECT_EQ(hit.v, 0.125f);
  }
}

TEST(ClosestHit, MissesInAnEmptyTree) {
  EXPECT_EQ(closest_hit({}, {}, ray_from(vec3(0), vec3(1))).triangle, NO_TRIANGLE);
}

TEST(ClosestHit, TakesATreeOfAnyDepth) {
  constexpr std::uint32_t LEAVES = 100000;
  const std::vector<Triangle> triangles(LEAVES, FLOOR);
  std::vector<Node> nodes = {{vec3(0), 1, vec3(1, 1, 0), LEAVES - 1}};
  for (std::uint32_t i = 1; i < LEAVES; ++i) {
    nodes.push_back({vec3(0), LEAVES - i, vec3(1, 1, 0), 0});
    nodes.push_back({vec3(0), i + 1 < LEAVES ? 2 * i + 1 : 0, vec3(1, 1, 0), LEAVES - 1 - i});
  }
  EXPECT_EQ(closest_hit(nodes, triangles, ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1))).triangle, 0u);
}

class TraceAll : public testing::Test {
 protected:
  TraceAll() {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
      const vec3 a = random.in_cube();
      const vec3 b = random.in_cube();
      const vec3 c = random.in_cube();
      triangles_.push_back({a, b, c});
    }
    for (int i = 0; i < 5000; ++i) {
      const vec3 origin = random.in_cube() * 2.0f;
      rays_.push_back(ray_from(origin, random.direction()));
    }
  }

  void expect_as_one_by_one(std::span<const Node> nodes) const {
    std::vector<Hit> hits(rays_.size());
    trace_all(nodes, triangles_, rays_, hits);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      EXPECT_TRUE(same_bits(hits[i], brute_force_hit(triangles_, rays_[i]))) << i;
    }
  }

  std::vector<Triangle> triangles_;
  std::vector<Ray> rays_;
};

TEST_F(TraceAll, FindsTheHitOfEachRay) { expect_as_one_by_one(build_ploc(triangles_).nodes); }

TEST_F(TraceAll, TestsEveryTriangleWithoutNodes) { expect_as_one_by_one({}); }

TEST_F(TraceAll, GivesTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<Node> nodes = build_ploc(triangles_).nodes;
  for (const int threads : {2, 4}) {
    // TBB starts no more threads than there are processors unless it is told to.
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute([&] {
      ASSERT_EQ(tbb::this_task_arena::max_concurrency(), threads);
      expect_as_one_by_one(nodes);
      expect_as_one_by_one({});
    });
  }
}

TEST_F(TraceAll, RefusesSpansOfDifferentLengths) {
  std::vector<Hit> hits(rays_.size() - 1);
  EXPECT_THROW(trace_all({}, triangles_, rays_, hits), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
