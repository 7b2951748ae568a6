// The referee of the tests that compare tracers lets no planted fault pass.
#include <gtest/gtest.h>

#include "analysis/cpu_tracer.h"
#include "scene/generators.h"
#include "support/floor.h"
#include "support/hit_referee.h"
#include "support/rays.h"
#include "support/triangles.h"

namespace coppice {
namespace {

const Triangle CEILING{vec3(0, 0, 1), vec3(1, 0, 1), vec3(0, 1, 1)};
const std::vector<Triangle> TWO_STOREYS = {FLOOR, CEILING};

// Down from z = 2, so that CEILING is at t = 1 and FLOOR at t = 2.
Ray down_on_both(float x, float y) { return down_at(x, y, 2); }

Verdict judge(const Ray& ray, const Hit& one, const Hit& other,
              const std::vector<Triangle>& triangles = TWO_STOREYS) {
  const HitReferee referee(triangles);
  EXPECT_EQ(referee.judge(ray, one, other), referee.judge(ray, other, one));
  return referee.judge(ray, one, other);
}

TEST(HitReferee, TakesTheSameHitForTheSame) {
  EXPECT_EQ(judge(down_on_both(0.2f, 0.2f), {1, 1, 0.2f, 0.2f}, {1, 1, 0.2f, 0.2f}), Verdict::same);
  EXPECT_EQ(judge(down_on_both(0.2f, 0.2f), {1, 1, 0.2f, 0.2f}, {1 + 1e-6f, 1, 0.2f, 0.2f}), Verdict::same);
  EXPECT_EQ(judge(down_on_both(5, 5), MISS, MISS), Verdict::same);
}

TEST(HitReferee, SeesATie) {
  const std::vector<Triangle> twice = {FLOOR, FLOOR};
  EXPECT_EQ(judge(down_on_both(0.2f, 0.2f), {2, 0, 0, 0}, {2, 1, 0, 0}, twice), Verdict::tie);
}

TEST(HitReferee, ForgivesAMissAtAnEdge) {
  EXPECT_EQ(judge(down_on_both(0.5f, 1e-7f), {1, 1, 0, 0}, MISS), Verdict::borderline);
  EXPECT_EQ(judge(down_on_both(0.5f, -1e-7f), {1, 1, 0, 0}, MISS), Verdict::borderline);
  EXPECT_EQ(judge(down_on_both(0.5f, 1e-7f), {1, 1, 0, 0}, {2, 0, 0, 0}), Verdict::borderline);
}

TEST(HitReferee, RefusesAMissInsideOfATriangle) {
  EXPECT_EQ(judge(down_on_both(0.5f, 1e-4f), {1, 1, 0, 0}, MISS), Verdict::wrong);
  EXPECT_EQ(judge(down_on_both(0.5f, 1e-4f), {1, 1, 0, 0}, {2, 0, 0, 0}), Verdict::wrong);
}

TEST(HitReferee, RefusesAHitOutsideOfATriangle) {
  EXPECT_EQ(judge(down_on_both(0.5f, -1e-4f), {1, 1, 0, 0}, MISS), Verdict::wrong);
  EXPECT_EQ(judge(down_on_both(0.5f, -1e-4f), {1, 1, 0, 0}, {1, 1, 0, 0}), Verdict::wrong);
}

TEST(HitReferee, RefusesAHitOfATriangleWithoutArea) {
  const std::vector<Triangle> segment = {{vec3(0), vec3(0.5f, 0, 0), vec3(1, 0, 0)}};
  EXPECT_EQ(judge(down_on_both(0.5f, 0), {2, 0, 0, 0}, MISS, segment), Verdict::wrong);
}

// Faults planted into the hits of a tracer, wherever these are well inside of their triangles.
class PlantedFault : public testing::Test {
 protected:
  template <class Fault>
  void expect_refused(Fault plant) const {
    const std::vector<Triangle> triangles = triangles_of(make_scatter(1000));
    const std::vector<Ray> rays = rays_at_edges(triangles, 5000, 1);
    std::vector<Hit> hits(rays.size());
    trace_all({}, triangles, rays, hits);
    const HitReferee referee(triangles);
    int planted = 0, refused = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit& hit = hits[i];
      ASSERT_EQ(referee.judge(rays[i], hit, hit), Verdict::same) << i;
      if (hit.triangle == NO_TRIANGLE || std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < 0.02f) continue;
      ++planted;
      refused += referee.judge(rays[i], hit, plant(hit)) == Verdict::wrong;
    }
    EXPECT_GT(planted, 100);
    EXPECT_GE(refused, planted - planted / 100);  // some rays are almost in the plane of their triangle
  }
};

TEST_F(PlantedFault, AMissIsRefused) {
  expect_refused([](const Hit&) { return MISS; });
}

TEST_F(PlantedFault, AnotherDistanceIsRefused) {
  expect_refused([](Hit hit) {
    hit.t *= 1.01f;
    return hit;
  });
}

TEST_F(PlantedFault, AnotherTriangleIsRefused) {
  expect_refused([](Hit hit) {
    hit.triangle = (hit.triangle + 1) % 1000;
    return hit;
  });
}

}  // namespace
}  // namespace coppice
