#include <gtest/gtest.h>

#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <vector>

#include "analysis/cpu_tracer.h"
#include "analysis/exact_hit.h"
#include "analysis/hard_rays.h"
#include "builders/ploc.h"
#include "builders/sbvh.h"
#include "support/floor.h"
#include "support/split_trees.h"
#include "support/triangles.h"

namespace coppice {
namespace {

float above(float x) { return std::nextafter(x, INFINITE); }
float below(float x) { return std::nextafter(x, -INFINITE); }

TEST(ExactMeeting, FindsDistanceAndBarycentricCoordinates) {
  const ExactMeeting meeting = exact_meeting(FLOOR, ray_from(vec3(0.25f, 0.125f, 3), vec3(0, 0, -2)));
  EXPECT_TRUE(meeting.meets);
  EXPECT_TRUE(meeting.in_range);
  EXPECT_FALSE(meeting.on_border);
  EXPECT_EQ(meeting.t, 1.5);
  EXPECT_EQ(meeting.u, 0.25);
  EXPECT_EQ(meeting.v, 0.125);
}

TEST(ExactMeeting, SeesBothSidesAndBehindTheOrigin) {
  EXPECT_EQ(exact_meeting(FLOOR, ray_from(vec3(0.25f, 0.25f, -1), vec3(0, 0, 1))).t, 1);
  const ExactMeeting behind = exact_meeting(FLOOR, ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, 1)));
  EXPECT_TRUE(behind.meets);
  EXPECT_FALSE(behind.in_range);
  EXPECT_EQ(behind.t, -1);
}

TEST(ExactMeeting, TakesTheBorderForAPart) {
  for (const auto& [x, y] : std::to_array<std::array<float, 2>>(
           {{0, 0}, {1, 0}, {0, 1}, {0.3f, 0}, {0, 0.7f}, {0.5f, 0.5f}, {0.25f, 0.75f}})) {
    const ExactMeeting meeting = exact_meeting(FLOOR, down_at(x, y));
    EXPECT_TRUE(meeting.meets) << x << ", " << y;
    EXPECT_TRUE(meeting.on_border) << x << ", " << y;
    EXPECT_EQ(meeting.u, double{x});
    EXPECT_EQ(meeting.v, double{y});
  }
}

TEST(ExactMeeting, TellsOneUlpBesideTheBorder) {
  const float least = std::numeric_limits<float>::denorm_min();
  EXPECT_FALSE(exact_meeting(FLOOR, down_at(0.25f, -least)).meets);
  EXPECT_TRUE(exact_meeting(FLOOR, down_at(0.25f, least)).meets);
  EXPECT_FALSE(exact_meeting(FLOOR, down_at(0.25f, least)).on_border);
  EXPECT_FALSE(exact_meeting(FLOOR, down_at(-least, 0.25f)).meets);
  EXPECT_FALSE(exact_meeting(FLOOR, down_at(0.5f, above(0.5f))).meets);
  EXPECT_TRUE(exact_meeting(FLOOR, down_at(0.5f, below(0.5f))).meets);
  EXPECT_FALSE(exact_meeting(FLOOR, down_at(0.5f, below(0.5f))).on_border);
}

TEST(ExactMeeting, TellsWhatDoubleCannot) {
  // 2^-100 beside a diagonal whose ends are at 2^100: the distance from the ends is rounded in double.
  const float far = 0x1p100f, near = 0x1p-100f;
  const Triangle triangle{vec3(-far, -far, 0), vec3(far, far, 0), vec3(-far, far, 0)};
  EXPECT_TRUE(exact_meeting(triangle, down_at(0, 0)).on_border);
  EXPECT_FALSE(exact_meeting(triangle, down_at(near, 0)).meets);
  EXPECT_TRUE(exact_meeting(triangle, down_at(-near, 0)).meets);
  EXPECT_FALSE(exact_meeting(triangle, down_at(-near, 0)).on_border);
}

TEST(ExactMeeting, MeetsNothingInThePlane) {
  EXPECT_FALSE(exact_meeting(FLOOR, ray_from(vec3(-1, 0.25f, 0), vec3(1, 0, 0))).meets);
  EXPECT_FALSE(exact_meeting(FLOOR, ray_from(vec3(-1, 0, 0), vec3(1, 0, 0))).meets);
  EXPECT_TRUE(exact_meeting(FLOOR, ray_from(vec3(-1, 0.25f, 1e-30f), vec3(1, 0, -0.8e-30f))).meets);
}

TEST(ExactMeeting, ComparesTheEndsOfTheRangeExactly) {
  Ray ray = ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -3));
  EXPECT_EQ(exact_meeting(FLOOR, ray).t, 1.0 / 3.0);
  const float rounded_up = 1.0f / 3.0f;
  ASSERT_GT(double{rounded_up}, 1.0 / 3.0);
  ray.t_max = rounded_up;
  EXPECT_TRUE(exact_meeting(FLOOR, ray).in_range);
  ray.t_max = below(rounded_up);
  EXPECT_FALSE(exact_meeting(FLOOR, ray).in_range);
  ray.t_max = INFINITE;
  ray.t_min = rounded_up;
  EXPECT_FALSE(exact_meeting(FLOOR, ray).in_range);
  ray.t_min = below(rounded_up);
  EXPECT_TRUE(exact_meeting(FLOOR, ray).in_range);
  ray.t_min = INFINITE;
  EXPECT_FALSE(exact_meeting(FLOOR, ray).in_range);
  ray = down_at(0.25f, 0.25f);
  ray.t_min = ray.t_max = 1;
  EXPECT_TRUE(exact_meeting(FLOOR, ray).in_range);
  ray = ray_from(vec3(0.25f, 0.25f, 0), vec3(0, 0, 1));
  ray.t_max = 0;
  EXPECT_TRUE(exact_meeting(FLOOR, ray).in_range);
}

TEST(ExactMeeting, HoldsAtTheEndsOfTheRangeOfFloat) {
  const float most = 3e38f;
  const Triangle huge{vec3(-most, -most, -most), vec3(most, -most, -most), vec3(0, most, -most)};
  const ExactMeeting far = exact_meeting(huge, ray_from(vec3(0, 0, most), vec3(0, 0, -most)));
  EXPECT_TRUE(far.meets);
  EXPECT_EQ(far.t, 2);
  EXPECT_EQ(far.u, 0.25);
  EXPECT_EQ(far.v, 0.5);

  const float least = std::numeric_limits<float>::denorm_min();
  const Triangle tiny{vec3(0), vec3(4 * least, 0, 0), vec3(0, 4 * least, 0)};
  const ExactMeeting near = exact_meeting(tiny, ray_from(vec3(least, least, least), vec3(0, 0, -0.5f)));
  EXPECT_TRUE(near.meets);
  EXPECT_EQ(near.t, 2 * double{least});
  EXPECT_EQ(near.u, 0.25);
  EXPECT_EQ(near.v, 0.25);
  EXPECT_FALSE(exact_meeting(tiny, ray_from(vec3(3 * least, 2 * least, most), vec3(0, 0, -most))).meets);
}

TEST(ExactMeeting, RoundsToNearest) {
  const auto t_above = [](float at_a, float at_c) {
    const Triangle triangle{vec3(0, 0, -at_a), vec3(1, 0, 0), vec3(0, 1, -at_c)};
    return exact_meeting(triangle, down_at(0.25f, 0.25f)).t;  // 1 + at_a / 2 + at_c / 4
  };
  EXPECT_EQ(t_above(0x1p-51f, 0), 1 + 0x1p-52);
  EXPECT_EQ(t_above(0x1p-52f, 0), 1);                   // half-way, to even
  EXPECT_EQ(t_above(0x1p-52f, 0x1p-98f), 1 + 0x1p-52);  // just above half-way
  EXPECT_EQ(t_above(0x1p-52f, -0x1p-98f), 1);           // just below
  EXPECT_EQ(t_above(0x1p-52f, 0x1p-50f), 1 + 0x1p-51);  // three halves, to even
}

TEST(ExactMeeting, TakesDenormalDirectionComponentsForZero) {
  const Ray askew = ray_from(vec3(0.25f, 0.125f, 1), vec3(1e-38f, -1e-38f, -2e-38f));
  EXPECT_EQ(exact_meeting(FLOOR, askew).u, 0.25);
  EXPECT_EQ(exact_meeting(FLOOR, askew).v, 0.125);
  EXPECT_FALSE(exact_meeting(FLOOR, ray_from(vec3(0.25f, 0.25f, 1), vec3(0, 0, -1e-38f))).meets);
}

TEST(ExactMeeting, MeetsNoInactiveOrDegenerateTriangle) {
  Triangle inactive = FLOOR;
  inactive.c.y = INFINITE;
  EXPECT_FALSE(exact_meeting(inactive, down_at(0.25f, 0.25f)).meets);
  EXPECT_FALSE(is_exactly_degenerate(inactive));
  const Triangle segment{vec3(0), vec3(1, 1, 1), vec3(3, 3, 3)};
  EXPECT_FALSE(exact_meeting(segment, down_at(0.5f, 0.5f)).meets);
  EXPECT_TRUE(is_exactly_degenerate(segment));
  EXPECT_TRUE(is_exactly_degenerate({vec3(2), vec3(2), vec3(5, 0, 1)}));
  EXPECT_FALSE(is_exactly_degenerate({vec3(0), vec3(1, 1, 1), vec3(3, 3, above(3))}));
  EXPECT_FALSE(is_exactly_degenerate({vec3(-0x1p100f), vec3(0x1p100f), vec3(0, 0, 0x1p-100f)}));
}

TEST(CanHit, RefusesRaysThatAreNone) {
  const Ray sound = down_at(0.25f, 0.25f);
  EXPECT_TRUE(can_hit(sound));
  for (const float odd : {NOT_A_NUMBER, INFINITE, -INFINITE}) {
    Ray ray = sound;
    ray.origin.y = odd;
    EXPECT_FALSE(can_hit(ray));
    ray = sound;
    ray.direction.x = odd;
    EXPECT_FALSE(can_hit(ray));
  }
  EXPECT_FALSE(can_hit({sound.origin, NOT_A_NUMBER, sound.direction, INFINITE}));
  EXPECT_FALSE(can_hit({sound.origin, 0, sound.direction, NOT_A_NUMBER}));
  EXPECT_FALSE(can_hit({sound.origin, 2, sound.direction, 1}));
  EXPECT_TRUE(can_hit({sound.origin, 1, sound.direction, 1}));
  EXPECT_FALSE(can_hit({sound.origin, 0, vec3(0, -0.0f, 0), 1}));
  EXPECT_FALSE(can_hit({sound.origin, 0, vec3(1e-40f, below(FLT_MIN), 0), 1}));
  EXPECT_TRUE(can_hit({sound.origin, 0, vec3(1e-40f, FLT_MIN, 0), 1}));
}

// Small integers, where int64 is exact and ties and borders abound. Moeller and Trumbore's terms.
TEST(ExactMeeting, AgreesWithIntegersOnAGrid) {
  Random random(5);
  const auto corner = [&] {
    const int x = static_cast<int>(random.below(9)) - 4, y = static_cast<int>(random.below(9)) - 4;
    return glm::ivec3(x, y, static_cast<int>(random.below(9)) - 4);
  };
  const auto dot = [](glm::ivec3 a, glm::ivec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  const auto cross = [](glm::ivec3 a, glm::ivec3 b) {
    return glm::ivec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  };
  int met = 0, on_border = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::ivec3 a = corner(), b = corner(), c = corner(), origin = corner(), direction = corner();
    const glm::ivec3 p = cross(direction, c - a), q = cross(origin - a, b - a);
    const int sign = dot(b - a, p) < 0 ? -1 : 1;
    const int determinant = sign * dot(b - a, p), u = sign * dot(origin - a, p), v = sign * dot(direction, q);
    const bool meets = determinant > 0 && u >= 0 && v >= 0 && u + v <= determinant;
    const Triangle triangle{vec3(a), vec3(b), vec3(c)};
    const ExactMeeting meeting = exact_meeting(triangle, ray_from(vec3(origin), vec3(direction)));
    ASSERT_EQ(meeting.meets, meets) << i;
    if (!meets) continue;
    ++met;
    on_border += meeting.on_border;
    const double t = double(sign * dot(c - a, q)) / determinant;
    ASSERT_EQ(meeting.t, t) << i;
    ASSERT_EQ(meeting.u, double(u) / determinant) << i;
    ASSERT_EQ(meeting.v, double(v) / determinant) << i;
    ASSERT_EQ(meeting.in_range, t >= 0) << i;
    ASSERT_EQ(meeting.on_border, u == 0 || v == 0 || u + v == determinant) << i;
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(on_border, 200);
}

TEST(ClosestExact, TellsDistancesThatAreOneInDouble) {
  const float far = 0x1p60f, apart = 0x1p-20f;
  const std::vector<Triangle> triangles = {{vec3(0, 0, -apart), vec3(1, 0, -apart), vec3(0, 1, -apart)},
                                           FLOOR};
  const Ray ray = ray_from(vec3(0.25f, 0.25f, far), vec3(0, 0, -1));
  EXPECT_EQ(compare_distances(triangles[0], triangles[1], ray), 1);
  EXPECT_EQ(compare_distances(triangles[1], triangles[0], ray), -1);
  EXPECT_EQ(compare_distances(triangles[1], triangles[1], ray), 0);
  EXPECT_EQ(closest_exact({}, triangles, ray).triangle, 1u);
  EXPECT_EQ(closest_exact(build_ploc(triangles).nodes, triangles, ray).triangle, 1u);
}

TEST(ClosestExact, TakesTheSmallestIndexOfEqualDistances) {
  const Triangle turned{FLOOR.b, FLOOR.c, FLOOR.a};
  const std::vector<Triangle> triangles = {{vec3(5), vec3(6), vec3(5, 5, 6)}, turned, FLOOR, turned, FLOOR};
  const ExactHit hit = closest_exact(build_ploc(triangles).nodes, triangles, down_at(0.25f, 0.25f));
  EXPECT_EQ(hit.triangle, 1u);
  EXPECT_EQ(hit.meeting.t, 1);
}

TEST(ClosestExact, MissesWhereThereIsNothing) {
  EXPECT_EQ(closest_exact({}, {}, down_at(0, 0)).triangle, NO_TRIANGLE);
  const std::vector<Triangle> floor = {FLOOR};
  EXPECT_EQ(closest_exact({}, floor, down_at(2, 2)).triangle, NO_TRIANGLE);
  EXPECT_EQ(closest_exact({}, floor, ray_from(vec3(0.25f, 0.25f, 1), vec3(0))).triangle, NO_TRIANGLE);
}

void expect_same(const ExactHit& a, const ExactHit& b) {
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.meeting.t, b.meeting.t);
  EXPECT_EQ(a.meeting.u, b.meeting.u);
  EXPECT_EQ(a.meeting.v, b.meeting.v);
}

// All triangles, each exactly, without filter or tree.
ExactHit slowly(const std::vector<Triangle>& triangles, const Ray& ray) {
  ExactHit best;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const ExactMeeting meeting = exact_meeting(triangles[i], ray);
    if (!meeting.meets || !meeting.in_range) continue;
    if (best.triangle == NO_TRIANGLE || compare_distances(triangles[i], triangles[best.triangle], ray) < 0) {
      best = {i, meeting};
    }
  }
  return best;
}

class ClosestExactOn : public testing::TestWithParam<HardCase> {};

TEST_P(ClosestExactOn, IsTheSameThroughATreeAndSlowly) {
  std::vector<Triangle> triangles = hard_triangles(GetParam());
  triangles.resize(60);
  const Bvh bvh = build_ploc(triangles);
  for (const RayKindName& kind : ray_kinds()) {
    SCOPED_TRACE(kind.name);
    for (const Ray& ray : hard_rays(kind.kind, triangles, bvh.nodes, 20, 3)) {
      const ExactHit expected = slowly(triangles, ray);
      expect_same(closest_exact(bvh.nodes, triangles, ray), expected);
      expect_same(closest_exact({}, triangles, ray), expected);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(HardCases, ClosestExactOn, testing::ValuesIn(hard_cases()),
                         [](const auto& suite) { return name_of(suite.param); });

TEST(ClosestExact, AgreesWithTheTracerInDouble) {
  const std::vector<Triangle> triangles = random_soup(1000, 4);
  const Bvh bvh = build_ploc(triangles);
  int hits = 0;
  for (const Ray& ray : hard_rays(RayKind::RANDOM, triangles, bvh.nodes, 3000, 8)) {
    const ExactHit exact = closest_exact(bvh.nodes, triangles, ray);
    const Hit traced = closest_hit(bvh.nodes, triangles, ray);
    ASSERT_EQ(exact.triangle, traced.triangle);
    if (exact.triangle == NO_TRIANGLE) continue;
    ++hits;
    EXPECT_FLOAT_EQ(traced.t, static_cast<float>(exact.meeting.t));
    EXPECT_NEAR(traced.u, exact.meeting.u, 0x1p-24);
    EXPECT_NEAR(traced.v, exact.meeting.v, 0x1p-24);
  }
  EXPECT_GT(hits, 500);
}

TEST(ClosestExact, GoesThroughATreeOfSplitTriangles) {
  const std::vector<Triangle> triangles = needles(200, 6);
  const Bvh bvh = build_sbvh(triangles);
  ASSERT_GT(bvh.references, triangles.size());
  for (const Ray& ray : hard_rays(RayKind::RANDOM, triangles, bvh.nodes, 500, 9)) {
    expect_same(closest_exact(bvh.nodes, triangles, ray), closest_exact({}, triangles, ray));
  }
}

}  // namespace
}  // namespace coppice
