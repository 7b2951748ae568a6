// The watertight triangle test of the twins, which the kernels equal bit for bit, against exact arithmetic:
// at every scale, on needles and on triangles without area, and on every hard case from many seeds.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "analysis/exact_hit.h"
#include "analysis/hard_rays.h"
#include "analysis/judge_hits.h"
#include "analysis/ray_targets.h"
#include "builders/ploc.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/stages.h"
#include "support/floor.h"
#include "support/random_scenes.h"
#include "support/triangles.h"
#include "twins/error_free.h"
#include "twins/intersect.h"

namespace coppice {
namespace {

Hit miss_of(const Ray& ray) { return {ray.t_max, NO_TRIANGLE, 0, 0}; }

// Every triangle by every ray.
std::vector<Hit> brute_force(std::span<const Triangle> triangles, std::span<const Ray> rays) {
  std::vector<Hit> hits;
  for (const Ray& given : rays) {
    hits.push_back(miss_of(given));
    const twins::TraceRay ray(given);
    if (!ray.is_sound) continue;
    Hit hit = ray.prepared(hits.back());
    for (std::uint32_t k = 0; k < triangles.size(); ++k) {
      twins::ray_meets_triangle(ray, triangles[k], k, TRIANGLE_WATERTIGHT, hit);
    }
    ray.keep(hit, hits.back());
  }
  return hits;
}

template <class T>
std::uint64_t address_of(T& values) {
  return reinterpret_cast<std::uint64_t>(values.data());
}

// Through the tree, with the robust box test.
std::vector<Hit> through_tree(std::vector<Node>& nodes, std::vector<Triangle>& triangles,
                              std::vector<Ray>& rays) {
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back(miss_of(ray));
  std::vector<TraceCounters> counters(1);
  std::vector<BuildState> state(1);
  state[0].active_count = static_cast<std::uint32_t>(nodes.size() + 1) / 2;
  TraceClosestArgs args{};
  args.nodes.value = address_of(nodes);
  args.triangles.value = address_of(triangles);
  args.rays.value = address_of(rays);
  args.hits.value = address_of(hits);
  args.counters.value = address_of(counters);
  args.state.value = address_of(state);
  args.ray_count = static_cast<std::uint32_t>(rays.size());
  args.ray_mask = PRIMITIVE_MASK;
  args.stack_entries = TRACE_STACK_LIMIT;
  args.triangle_test = TRIANGLE_WATERTIGHT;
  args.box_test = BOX_ROBUST;
  twins::trace_closest(args);
  return hits;
}

std::string described(std::span<const Triangle> triangles, const Ray& ray, const Hit& hit) {
  char text[512];
  const vec3 &o = ray.origin, &d = ray.direction;
  std::snprintf(text, sizeof text, "ray %.9g %.9g %.9g to %.9g %.9g %.9g: triangle %d at %.9g: ", o.x, o.y,
                o.z, d.x, d.y, d.z, static_cast<int>(hit.triangle), hit.t);
  return text + std::string(why_false(triangles, ray, hit));
}

void expect_sound(std::span<const Node> nodes, std::span<const Triangle> triangles, std::span<const Ray> rays,
                  std::span<const Hit> hits, const std::string& what) {
  const HitVerdicts verdicts = judge_hits(nodes, triangles, rays, hits);
  const auto example = [&](std::uint64_t i) {
    return i == HitVerdicts::NO_RAY ? "" : described(triangles, rays[i], hits[i]);
  };
  EXPECT_EQ(verdicts.false_hits, 0u) << what << ": " << example(verdicts.example_false);
  EXPECT_EQ(verdicts.missed, 0u) << what << ": " << example(verdicts.example_missed);
}

// Products of floats are exact in double, and their difference in long double where they are of about one
// size.
TEST(DifferenceOfProducts, IsOffByThreeRoundingsAtMost) {
  DoubleRandom random(1);
  double worst = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    const auto a = static_cast<float>(random.uniform(1, 2)), b = static_cast<float>(random.uniform(1, 2));
    const auto c = static_cast<float>(random.uniform(1, 2));
    const auto near = static_cast<float>(double{a} * b / c);
    const float d = random.coin() ? near : std::nextafter(near, random.coin() ? 4.0f : 0.0f);
    const long double exact =
        static_cast<long double>(double{a} * b) - static_cast<long double>(double{c} * d);
    const float computed = twins::difference_of_products(a, b, c, d);
    if (exact == 0) {
      ASSERT_EQ(computed, 0);
      continue;
    }
    worst = std::max(worst, static_cast<double>(std::fabs((computed - exact) / exact)));
  }
  EXPECT_LE(worst, 0x1.8p-23);
}

// Depths and edge functions may both be small, and their products are no floats any more.
TEST(Watertight, KeepsDistancesAtEveryScale) {
  for (int exponent = -112; exponent <= 30; ++exponent) {
    std::vector<Triangle> triangles = random_soup(50, 5);
    for (Triangle& triangle : triangles) {
      for (vec3* const corner : {&triangle.a, &triangle.b, &triangle.c}) {
        *corner *= std::ldexp(1.0f, exponent);
      }
    }
    for (const RayKind kind : {RayKind::ALONG_EDGES, RayKind::IN_PLANES, RayKind::RANDOM}) {
      const std::vector<Ray> rays = hard_rays(kind, triangles, {}, exponent < -95 ? 2000 : 50, 3);
      expect_sound({}, triangles, rays, brute_force(triangles, rays), "at 2^" + std::to_string(exponent));
    }
  }
}

// A triangle around the z axis whose corners, seen along it, are integers near 2^22 that span the least area
// there is: (p, q) and (r, s) with ps - qr = 1, and minus their sum, so that the axis passes with equal
// shares.
std::optional<Triangle> thinnest_triangle(DoubleRandom& random) {
  const auto depth = [&] { return 1.0f + static_cast<float>(random.below(1024)) * 0x1p-10f; };
  const std::int64_t p = 0x200000 + random.below(0x200000), q = 0x200000 + random.below(0x200000);
  if (std::gcd(p, q) != 1) return std::nullopt;
  // By Euclid: p * s = 1 modulo q.
  std::int64_t s = 1, other = 0, high = p, low = q;
  while (low != 0) {
    const std::int64_t quotient = high / low;
    s = std::exchange(other, s - quotient * other);
    high = std::exchange(low, high - quotient * low);
  }
  const std::int64_t r = (p * s - 1) / q;
  const auto corner = [&](std::int64_t x, std::int64_t y) {
    return vec3(static_cast<float>(x), static_cast<float>(y), depth());
  };
  return Triangle{corner(p, q), corner(r, s), corner(-p - r, -q - s)};
}

TEST(Watertight, KnowsWhereItMeetsTheThinnestTriangles) {
  DoubleRandom random(1);
  const Ray ray{vec3(0), 0, vec3(0, 0, 1), INFINITE};
  int met = 0;
  while (met < 10000) {
    const std::optional<Triangle> triangle = thinnest_triangle(random);
    if (!triangle) continue;
    ++met;
    const ExactMeeting exact = exact_meeting(*triangle, ray);
    ASSERT_TRUE(exact.meets);
    ASSERT_NEAR(exact.u, 1.0 / 3, 1e-9);
    const Hit hit = brute_force({&*triangle, 1}, {&ray, 1})[0];
    ASSERT_EQ(hit.triangle, 0u);
    ASSERT_NEAR(hit.u, exact.u, 0x1p-22);
    ASSERT_NEAR(hit.v, exact.v, 0x1p-22);
    ASSERT_NEAR(hit.t, exact.t, 0x1p-21);
  }
}

// Three corners on a line, exactly or as nearly as floats allow.
std::vector<Triangle> thin_triangles(std::uint32_t count, std::uint64_t seed) {
  DoubleRandom random(seed);
  std::vector<Triangle> triangles;
  const auto grid_point = [&] {
    const auto next = [&] { return static_cast<float>(random.below(2048)) * 0x1p-10f - 1; };
    const float x = next(), y = next(), z = next();
    return vec3(x, y, z);
  };
  while (triangles.size() < count) {
    const vec3 a = grid_point(), c = grid_point();
    if (a == c) continue;
    vec3 b = 0.5f * a + 0.5f * c;  // exact
    if (random.coin()) b = 0.75f * a + 0.25f * c;
    for (int axis = 0; axis < 3; ++axis) {
      if (random.below(4) == 0) b[axis] = std::nextafter(b[axis], random.coin() ? 2.0f : -2.0f);
      if (random.below(16) == 0)
        b[axis] += static_cast<float>(std::ldexp(1.0, -static_cast<int>(random.below(60))));
    }
    triangles.push_back({a, b, c});
  }
  return triangles;
}

TEST(Watertight, HitsThinTrianglesWhereTheRayPasses) {
  std::uint64_t on_segments = 0, hit_count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Triangle> triangles = thin_triangles(50, seed);
    for (const RayKindName& kind : ray_kinds()) {
      const std::vector<Ray> rays = hard_rays(kind.kind, triangles, {}, 100, seed);
      const std::vector<Hit> hits = brute_force(triangles, rays);
      expect_sound({}, triangles, rays, hits, std::string(kind.name));
      for (const Hit& hit : hits) {
        if (hit.triangle == NO_TRIANGLE) continue;
        ++hit_count;
        on_segments += is_exactly_degenerate(triangles[hit.triangle]);
      }
    }
  }
  EXPECT_GT(on_segments, 100u);
  EXPECT_GT(hit_count, 2 * on_segments);
}

TEST(Watertight, NeverHitsTrianglesWithTwoEqualCorners) {
  std::vector<Triangle> triangles = random_soup(100, 9);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Triangle& triangle = triangles[i];
    (i % 3 == 0 ? triangle.a : i % 3 == 1 ? triangle.b : triangle.c) = i % 3 == 2 ? triangle.a : triangle.c;
  }
  for (const RayKindName& kind : ray_kinds()) {
    const std::vector<Ray> rays = hard_rays(kind.kind, triangles, {}, 200, 3);
    for (const Hit& hit : brute_force(triangles, rays)) EXPECT_EQ(hit.triangle, NO_TRIANGLE) << kind.name;
  }
}

// An octahedron, every other face of which is cut at the middles of its edges. Where a cut edge meets a whole
// one, a triangle without area closes the mesh.
struct CutOctahedron {
  explicit CutOctahedron(std::uint64_t seed) {
    DoubleRandom random(seed);
    std::array<vec3, 6> ends;
    for (int end = 0; end < 6; ++end) {
      for (int axis = 0; axis < 3; ++axis) {
        ends[end][axis] = 2.0f * static_cast<float>(random.below(1u << 18)) - 0x1p18f;
      }
      ends[end][end / 2] =
          (end % 2 ? -1.0f : 1.0f) * (0x1p20f + 2.0f * static_cast<float>(random.below(1u << 18)));
    }
    for (int face = 0; face < 8; ++face) {
      const vec3 &a = ends[face & 1], &b = ends[2 + (face >> 1 & 1)], &c = ends[4 + (face >> 2)];
      if (std::popcount(static_cast<unsigned>(face)) % 2 == 0) {
        with_area.push_back({a, b, c});
        continue;
      }
      const vec3 ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
      with_area.insert(with_area.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
      segments.insert(segments.end(), {{a, ab, b}, {b, bc, c}, {c, ca, a}});
    }
  }

  std::vector<Triangle> with_area, segments;
};

std::uint64_t leaks_of(std::span<const Triangle> triangles, std::span<const Ray> rays) {
  std::uint64_t leaks = 0;
  for (const Hit& hit : brute_force(triangles, rays)) leaks += hit.triangle == NO_TRIANGLE;
  return leaks;
}

TEST(Watertight, TrianglesWithoutAreaCloseTheirGaps) {
  std::uint64_t leaks_without = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const CutOctahedron mesh(seed);
    std::vector<Triangle> closed = mesh.with_area;
    closed.insert(closed.end(), mesh.segments.begin(), mesh.segments.end());
    ASSERT_TRUE(std::ranges::all_of(mesh.segments, is_exactly_degenerate));
    DoubleRandom random(seed);
    const vec3 inside = to_float(0x1p16 * random.in_cube());
    const std::vector<Ray> rays = inside_rays(inside, closed, 10000, seed);
    EXPECT_EQ(leaks_of(closed, rays), 0u) << "seed " << seed;
    expect_sound({}, closed, rays, brute_force(closed, rays), "seed " + std::to_string(seed));
    leaks_without += leaks_of(mesh.with_area, rays);
  }
  EXPECT_GT(leaks_without, 0u);  // or the segments are not needed
}

// COPPICE_STABILITY_SEEDS says how many.
TEST(Watertight, NoHardCaseOfAnySeedLosesOrInventsAHit) {
  const std::uint64_t seeds = number_from_environment("COPPICE_STABILITY_SEEDS", 4);
  for (std::uint64_t seed = 1; seed <= seeds && !HasFailure(); ++seed) {
    for (const HardCase& hard_case : hard_cases()) {
      Scene scene = hard_case.make(std::min(hard_case.default_triangle_count, 100u), seed);
      bring_into_range(scene);
      std::vector<Triangle> triangles = scene_arrays(scene).triangles;
      std::vector<Node> nodes = build_ploc(triangles, {}).nodes;
      for (const RayKindName& kind : ray_kinds()) {
        std::vector<Ray> rays = hard_rays(kind.kind, triangles, nodes, 20, seed);
        const std::string what =
            std::string(hard_case.name) + ", seed " + std::to_string(seed) + ", " + std::string(kind.name);
        expect_sound(nodes, triangles, rays, through_tree(nodes, triangles, rays), what);
      }
    }
  }
}

}  // namespace
}  // namespace coppice
