#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/cpu_tracer.h"
#include "analysis/exact_hit.h"
#include "analysis/hard_rays.h"
#include "analysis/judge_hits.h"
#include "builders/ploc.h"
#include "support/floor.h"
#include "support/split_trees.h"
#include "support/triangles.h"
#include "twins/intersect.h"

namespace coppice {
namespace {

// Triangles, rays and the hits that someone reports.
struct Trial {
  Trial(std::vector<Triangle> given, RayKind kind, std::uint32_t count) : triangles(std::move(given)) {
    nodes = build_ploc(triangles).nodes;
    rays = hard_rays(kind, triangles, nodes, count, 7);
    hits.resize(rays.size());
    trace_all(nodes, triangles, rays, hits);
  }
  Trial(std::vector<Triangle> given, std::vector<Ray> given_rays, std::vector<Hit> given_hits)
      : triangles(std::move(given)), rays(std::move(given_rays)), hits(std::move(given_hits)) {}

  HitVerdicts judge() const { return judge_hits(nodes, triangles, rays, hits); }

  std::vector<Triangle> triangles;
  std::vector<Node> nodes;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};

class JudgeAccepts : public testing::TestWithParam<HardCase> {};

TEST_P(JudgeAccepts, TheTracerInDoubleOnRaysOfEveryKind) {
  std::vector<Triangle> triangles = hard_triangles(GetParam());
  triangles.resize(std::min<std::size_t>(triangles.size(), 300));
  for (const RayKindName& kind : ray_kinds()) {
    const Trial trial(triangles, kind.kind, 200);
    const HitVerdicts verdicts = trial.judge();
    EXPECT_EQ(verdicts.rays, 200u);
    EXPECT_EQ(verdicts.missed, 0u) << kind.name << " ray " << verdicts.example_missed;
    EXPECT_EQ(verdicts.false_hits, 0u) << kind.name << " ray " << verdicts.example_false;
  }
}

INSTANTIATE_TEST_SUITE_P(HardCases, JudgeAccepts, testing::ValuesIn(hard_cases()),
                         [](const auto& suite) { return name_of(suite.param); });

TEST(JudgeHits, CountsAndMeasuresRightHits) {
  const Trial trial(random_soup(2000, 3), RayKind::RANDOM, 5000);
  const HitVerdicts verdicts = trial.judge();
  EXPECT_EQ(verdicts.rays, 5000u);
  EXPECT_EQ(verdicts.hits, verdicts.exact_hits);
  EXPECT_GT(verdicts.hits, 1000u);
  EXPECT_EQ(verdicts.missed + verdicts.missed_at_edges + verdicts.false_hits + verdicts.other_triangle, 0u);
  EXPECT_EQ(verdicts.example_missed, HitVerdicts::NO_RAY);
  EXPECT_EQ(verdicts.example_false, HitVerdicts::NO_RAY);
  // The tracer computes in double and rounds once.
  EXPECT_GT(verdicts.worst_t_ulps, 0.4);
  EXPECT_LT(verdicts.worst_t_ulps, 0.501);
  EXPECT_LT(verdicts.worst_uv_ulps, 0.501);
}

TEST(JudgeHits, IsTheSameWithoutATree) {
  const Trial trial(random_soup(200, 3), RayKind::EDGES, 300);
  const HitVerdicts with = trial.judge();
  const HitVerdicts without = judge_hits({}, trial.triangles, trial.rays, trial.hits);
  EXPECT_EQ(with.exact_hits, without.exact_hits);
  EXPECT_EQ(with.missed_at_edges, without.missed_at_edges);
  EXPECT_EQ(with.behind_edges, without.behind_edges);
  EXPECT_EQ(with.other_triangle, without.other_triangle);
  EXPECT_EQ(with.worst_t_ulps, without.worst_t_ulps);
  EXPECT_EQ(with.example_t, without.example_t);
}

TEST(JudgeHits, RefusesSpansOfDifferentLengths) {
  EXPECT_THROW(judge_hits({}, {}, std::vector<Ray>(2), std::vector<Hit>(1)), std::invalid_argument);
}

// Every hit spoilt in the same way; a few may still be right by chance.
class PlantedErrors : public testing::Test {
 protected:
  template <class Spoil>
  HitVerdicts after(const Spoil& spoil) {
    for (std::size_t i = 0; i < trial_.rays.size(); ++i) {
      if (trial_.hits[i].triangle != NO_TRIANGLE) spoil(trial_.hits[i]);
    }
    return trial_.judge();
  }
  std::uint64_t nearly_all() const { return hit_count_ * 97 / 100; }

  Trial trial_{random_soup(1000, 3), RayKind::RANDOM, 2000};
  std::uint64_t hit_count_ = trial_.judge().hits;
};

TEST_F(PlantedErrors, AHitOnAnotherTriangle) {
  const HitVerdicts verdicts = after([](Hit& hit) { hit.triangle = (hit.triangle + 1) % 1000; });
  EXPECT_EQ(verdicts.false_hits, hit_count_);
  EXPECT_GE(verdicts.missed, nearly_all());
  const std::uint64_t example = verdicts.example_false;
  EXPECT_NE(why_false(trial_.triangles, trial_.rays[example], trial_.hits[example]), "");
}

TEST_F(PlantedErrors, ADistanceOffByOnePerCent) {
  EXPECT_GE(after([](Hit& hit) { hit.t *= 1.01f; }).false_hits, nearly_all());
}

TEST_F(PlantedErrors, ADistanceOffByATenthOfAPerMille) {
  EXPECT_GE(after([](Hit& hit) { hit.t *= 1.0001f; }).false_hits, hit_count_ / 2);
}

TEST_F(PlantedErrors, ALostHit) {
  const HitVerdicts verdicts = after([](Hit& hit) { hit = MISS; });
  EXPECT_EQ(verdicts.hits, 0u);
  EXPECT_EQ(verdicts.missed + verdicts.missed_at_edges, hit_count_);
  EXPECT_GE(verdicts.missed, nearly_all());
  EXPECT_EQ(verdicts.false_hits, 0u);
}

TEST_F(PlantedErrors, SwappedCoordinates) {
  EXPECT_GE(after([](Hit& hit) { std::swap(hit.u, hit.v); }).false_hits, nearly_all());
}

TEST_F(PlantedErrors, CoordinatesAndDistancesThatAreNoNumbers) {
  EXPECT_EQ(after([](Hit& hit) { hit.u = std::numeric_limits<float>::quiet_NaN(); }).false_hits, hit_count_);
  EXPECT_EQ(after([](Hit& hit) { hit.t = std::numeric_limits<float>::quiet_NaN(); }).false_hits, hit_count_);
}

TEST_F(PlantedErrors, AnIndexOutOfRange) {
  EXPECT_EQ(after([](Hit& hit) { hit.triangle = 1000; }).false_hits, hit_count_);
}

TEST_F(PlantedErrors, AnInventedHit) {
  std::uint64_t invented = 0;
  for (Hit& hit : trial_.hits) {
    if (hit.triangle == NO_TRIANGLE) hit = {1, static_cast<std::uint32_t>(++invented % 1000), 0.3f, 0.3f};
  }
  ASSERT_GT(invented, 300u);
  EXPECT_EQ(trial_.judge().false_hits, invented);
}

// A floor, and another below it.
const Triangle CELLAR{vec3(-4, -4, -1), vec3(8, -4, -1), vec3(-4, 8, -1)};

HitVerdicts judge_one(const std::vector<Triangle>& triangles, const Ray& ray, const Hit& hit) {
  return Trial(triangles, {ray}, {hit}).judge();
}

// The cellar's (u, v) below (x, y).
Hit cellar_at(float x, float y) { return {2, 1, (x + 4) / 12, (y + 4) / 12}; }

TEST(JudgeHits, CallsAHitBehindAClearOneMissed) {
  const HitVerdicts verdicts = judge_one({FLOOR, CELLAR}, down_at(0.25f, 0.25f), cellar_at(0.25f, 0.25f));
  EXPECT_EQ(verdicts.missed, 1u);
  EXPECT_EQ(verdicts.false_hits, 0u);
}

TEST(JudgeHits, TellsMissesAtEdgesFromOthers) {
  HitVerdicts verdicts = judge_one({FLOOR}, down_at(0.25f, 0), MISS);
  EXPECT_EQ(verdicts.missed, 0u);
  EXPECT_EQ(verdicts.missed_at_edges, 1u);
  verdicts = judge_one({FLOOR}, down_at(0.25f, 0x1p-17f), MISS);
  EXPECT_EQ(verdicts.missed, 1u);
  EXPECT_EQ(verdicts.missed_at_edges, 0u);
  verdicts = judge_one({FLOOR, CELLAR}, down_at(0.25f, 0), cellar_at(0.25f, 0));
  EXPECT_EQ(verdicts.missed + verdicts.missed_at_edges + verdicts.false_hits, 0u);
  EXPECT_EQ(verdicts.behind_edges, 1u);
  EXPECT_EQ(verdicts.other_triangle, 1u);
}

TEST(JudgeHits, CallsAHitBehindAnEdgeMissedWhereAClearOneIsLost) {
  // Nothing reported: the edge of the floor may be lost, the cellar may not.
  EXPECT_EQ(judge_one({FLOOR, CELLAR}, down_at(0.25f, 0), MISS).missed, 1u);
}

TEST(JudgeHits, AllowsHitsBesideTheBorderByLittle) {
  EXPECT_EQ(judge_one({FLOOR}, down_at(0.25f, -0x1p-19f), {1, 0, 0.25f, 0}).false_hits, 0u);
  EXPECT_EQ(judge_one({FLOOR}, down_at(0.25f, -0x1p-17f), {1, 0, 0.25f, 0}).false_hits, 1u);
}

TEST(JudgeHits, LeavesOpenWhatHappensAtTheEndsOfTheRange) {
  Ray ray = down_at(0.25f, 0.25f);
  for (const auto& [t_min, t_max] : {std::pair{1.0f, 2.0f}, {0.0f, 1.0f}}) {
    ray.t_min = t_min;
    ray.t_max = t_max;
    const HitVerdicts missed = judge_one({FLOOR}, ray, MISS);
    EXPECT_EQ(missed.exact_hits, 1u);
    EXPECT_EQ(missed.missed + missed.missed_at_edges, 0u);
    EXPECT_EQ(judge_one({FLOOR}, ray, {1, 0, 0.25f, 0.25f}).false_hits, 0u);
  }
  ray.t_max = 0.99f;
  EXPECT_EQ(judge_one({FLOOR}, ray, {1, 0, 0.25f, 0.25f}).false_hits, 1u);
}

TEST(JudgeHits, RefusesHitsOfWhatCannotBeHit) {
  const Hit hit{1, 0, 0.25f, 0.25f};
  Ray none = down_at(0.25f, 0.25f);
  none.direction.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(judge_one({FLOOR}, none, hit).false_hits, 1u);
  Triangle inactive = FLOOR;
  inactive.c.y = INFINITE;
  EXPECT_EQ(judge_one({inactive}, down_at(0.25f, 0.25f), hit).false_hits, 1u);
  for (const Triangle& without_three : {Triangle{vec3(0), vec3(0), vec3(1, 1, 0)},
                                        {vec3(0), vec3(1, 1, 0), vec3(0)},
                                        {vec3(1, 1, 0), vec3(0), vec3(0)}}) {
    const HitVerdicts verdicts = judge_one({without_three}, down_at(0.25f, 0.25f), {1, 0, 0.25f, 0.25f});
    EXPECT_EQ(verdicts.false_hits, 1u);
    EXPECT_EQ(verdicts.false_on_degenerate, 1u);
  }
}

// Rounding gives it an area, and around it a mesh has a gap of that size.
TEST(JudgeHits, AllowsHitsOfASegmentWhereTheRayPassesIt) {
  const Triangle segment{vec3(0), vec3(0.25f, 0.25f, 0), vec3(1, 1, 0)};
  const Ray ray = down_at(0.25f, 0.25f);
  const auto false_of = [&](const Triangle& triangle, const Ray& one, const Hit& hit) {
    const HitVerdicts verdicts = judge_one({triangle}, one, hit);
    EXPECT_EQ(verdicts.missed + verdicts.missed_at_edges, 0u);
    return verdicts.false_hits;
  };
  EXPECT_EQ(false_of(segment, ray, {1, 0, 1, 0}), 0u);
  EXPECT_EQ(false_of(segment, ray, {1, 0, 0, 0.25f}), 0u);
  EXPECT_EQ(false_of(segment, ray, {1 + 0x1p-18f, 0, 1, 0}), 0u);
  EXPECT_EQ(false_of(segment, ray, MISS), 0u);
  EXPECT_EQ(false_of(segment, ray, {1, 0, 0.5f, 0}), 1u);          // elsewhere on the segment
  EXPECT_EQ(false_of(segment, ray, {1 + 0x1p-16f, 0, 1, 0}), 1u);  // beside it along the ray
  EXPECT_EQ(false_of(segment, down_at(0.25f, 0.25f + 0x1p-16f), {1, 0, 1, 0}), 1u);  // and across
  EXPECT_EQ(false_of(segment, down_at(2, 2), {1, 0, 0, 1}), 1u);
  EXPECT_EQ(false_of(segment, ray, {1, 0, std::numeric_limits<float>::quiet_NaN(), 0}), 1u);
  // An area that double does not tell from none.
  const Triangle nearly{vec3(0), vec3(0.25f, 0.25f, 1e-30f), vec3(1, 1, 0)};
  ASSERT_FALSE(is_exactly_degenerate(nearly));
  EXPECT_EQ(false_of(nearly, ray, {1, 0, 1, 0}), 0u);
  EXPECT_EQ(false_of(nearly, ray, {1, 0, 0.5f, 0}), 1u);
}

// Along a plane seen almost edge-on t is known badly, but not beyond the triangle.
TEST(JudgeHits, BoundsTheDistanceWhereARayGrazes) {
  const Ray ray{vec3(-1, 0.25f, 1e-6f), 0.0f, vec3(1, 0, -1e-6f), INFINITE};
  const auto false_at = [&](float t, float u) {
    return judge_one({FLOOR}, ray, {t, 0, u, 0.25f}).false_hits;
  };
  EXPECT_EQ(exact_meeting(FLOOR, {vec3(-1, 0.25f, 0x1p-20f), 0, vec3(1, 0, -0x1p-20f), INFINITE}).t, 1);
  EXPECT_EQ(false_at(1.0f, 0.0f), 0u);
  EXPECT_EQ(false_at(1.2f, 0.2f), 0u);
  EXPECT_EQ(false_at(0.9f, 0.0f), 1u);
  EXPECT_EQ(false_at(2.1f, 0.75f), 1u);
}

// The accuracy of both triangle tests of the twins, in the report of the tests.
TEST(JudgeHits, MeasuresTheTriangleTests) {
  for (const uint triangle_test : {TRIANGLE_FAST, TRIANGLE_WATERTIGHT}) {
    Trial trial(random_soup(1000, 3), RayKind::RANDOM, 5000);
    for (std::size_t i = 0; i < trial.rays.size(); ++i) {
      const twins::TraceRay ray(trial.rays[i]);
      trial.hits[i] = {trial.rays[i].t_max, NO_TRIANGLE, 0, 0};
      Hit hit = ray.prepared(trial.hits[i]);
      for (std::uint32_t k = 0; k < trial.triangles.size(); ++k) {
        twins::ray_meets_triangle(ray, trial.triangles[k], k, triangle_test, hit);
      }
      ray.keep(hit, trial.hits[i]);
    }
    const HitVerdicts verdicts = trial.judge();
    const std::string prefix = triangle_test == TRIANGLE_FAST ? "fast_" : "watertight_";
    RecordProperty(prefix + "worst_t_ulps", std::to_string(verdicts.worst_t_ulps));
    RecordProperty(prefix + "worst_t_scaled", std::to_string(verdicts.worst_t_scaled));
    RecordProperty(prefix + "worst_uv_ulps", std::to_string(verdicts.worst_uv_ulps));
    EXPECT_GT(verdicts.hits, 1000u);
    EXPECT_EQ(verdicts.missed, 0u);
    EXPECT_EQ(verdicts.false_hits, 0u);
    // Single precision shows, but the room for rounding of judge_hits.h is not used up.
    EXPECT_GT(verdicts.worst_t_ulps, 1);
    EXPECT_LT(verdicts.worst_t_scaled, 1000);
  }
}

// Squares of 1e38 overflow: a test in plain single precision loses everything, and the judge must see it.
TEST(JudgeHits, SeesWhatOverflowLoses) {
  const HardCase& huge = *find_hard_case("huge");
  Trial trial(hard_triangles(huge), RayKind::RANDOM, 100);
  std::ranges::fill(trial.hits, MISS);
  const HitVerdicts verdicts = trial.judge();
  EXPECT_GT(verdicts.missed, 50u);
  EXPECT_EQ(trial.hits[verdicts.example_missed].triangle, NO_TRIANGLE);
}

}  // namespace
}  // namespace coppice
