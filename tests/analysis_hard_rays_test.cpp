#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <set>
#include <string>
#include <vector>

#include "analysis/cpu_tracer.h"
#include "analysis/exact_hit.h"
#include "analysis/hard_rays.h"
#include "analysis/judge_hits.h"
#include "builders/ploc.h"
#include "scene/bounds.h"
#include "scene/shapes.h"
#include "support/split_trees.h"
#include "support/triangles.h"

namespace coppice {
namespace {

constexpr std::uint32_t COUNT = 300;

bool is_denormal(float x) { return x != 0.0f && std::abs(x) < FLT_MIN; }

struct Encounter {
  std::vector<Triangle> triangles = random_soup(200, 3);
  std::vector<Node> nodes = build_ploc(triangles).nodes;
  std::vector<Ray> rays(RayKind kind) const { return hard_rays(kind, triangles, nodes, COUNT, 1); }
};

template <class Promise>
int count_rays(const std::vector<Ray>& rays, const Promise& promise) {
  return static_cast<int>(std::ranges::count_if(rays, promise));
}

TEST(RayKinds, HaveEachANameOfItsOwn) {
  std::set<std::string_view> names;
  for (const RayKindName& kind : ray_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.description.empty());
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(RayKind::RANDOM) + 1);
}

class HardRays : public testing::TestWithParam<RayKindName> {};

TEST_P(HardRays, DependOnTheSeedAlone) {
  const Encounter scene;
  const auto first = scene.rays(GetParam().kind), again = scene.rays(GetParam().kind);
  const auto other = hard_rays(GetParam().kind, scene.triangles, scene.nodes, COUNT, 2);
  ASSERT_EQ(first.size(), COUNT);
  EXPECT_EQ(std::memcmp(first.data(), again.data(), COUNT * sizeof(Ray)), 0);
  EXPECT_NE(std::memcmp(first.data(), other.data(), COUNT * sizeof(Ray)), 0);
}

TEST_P(HardRays, AreRaysOnEveryScene) {
  std::vector<std::vector<Triangle>> scenes = {
      {}, {{vec3(0), vec3(0), vec3(0)}}, {{vec3(7), vec3(7), vec3(7)}}};
  for (const HardCase& hard_case : hard_cases()) scenes.push_back(hard_triangles(hard_case));
  for (const std::vector<Triangle>& triangles : scenes) {
    for (const std::vector<Node>& nodes : {build_ploc(triangles).nodes, std::vector<Node>()}) {
      const auto rays = hard_rays(GetParam().kind, triangles, nodes, 50, 1);
      ASSERT_EQ(rays.size(), 50u);
      for (const Ray& ray : rays) {
        if (GetParam().kind == RayKind::NON_FINITE) {
          EXPECT_FALSE(can_hit(ray));
          continue;
        }
        EXPECT_TRUE(is_finite(ray.origin) && is_finite(ray.direction));
        if (GetParam().kind == RayKind::RANGES) continue;
        EXPECT_TRUE(ray.t_min == 0.0f && ray.t_max == std::numeric_limits<float>::infinity());
      }
    }
  }
}

std::string name_of_kind(const testing::TestParamInfo<RayKindName>& suite) {
  std::string name(suite.param.name);
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Kinds, HardRays, testing::ValuesIn(ray_kinds()), name_of_kind);

// What the kinds promise.

int count_on_border(const Encounter& scene, const std::vector<Ray>& rays) {
  return count_rays(rays, [&](const Ray& ray) {
    return std::ranges::any_of(
        scene.triangles, [&](const Triangle& triangle) { return exact_meeting(triangle, ray).on_border; });
  });
}

TEST(HardRaysAre, ExactlyThroughManyCornersAndSomeEdges) {
  const Encounter scene;
  EXPECT_GT(count_on_border(scene, scene.rays(RayKind::VERTICES)), 100);
  EXPECT_GT(count_on_border(scene, scene.rays(RayKind::EDGES)), 5);
  EXPECT_EQ(count_on_border(scene, scene.rays(RayKind::RANDOM)), 0);
}

TEST(HardRaysAre, InThePlanesOfAxisAlignedTriangles) {
  const std::vector<Triangle> flat = {{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}};
  for (const RayKind kind : {RayKind::ALONG_EDGES, RayKind::IN_PLANES}) {
    for (const Ray& ray : hard_rays(kind, flat, {}, COUNT, 1)) {
      EXPECT_TRUE(ray.origin.z == 0.0f && ray.direction.z == 0.0f);
    }
  }
}

TEST(HardRaysAre, InTheFacesOfBoxes) {
  const Encounter scene;
  for (const Ray& ray : scene.rays(RayKind::IN_BOX_FACES)) {
    EXPECT_TRUE(std::ranges::any_of(scene.nodes, [&](const Node& node) {
      bool is_in_face = false;
      for (int axis = 0; axis < 3; ++axis) {
        const float x = ray.origin[axis];
        is_in_face |= ray.direction[axis] == 0.0f && (x == node.box_min[axis] || x == node.box_max[axis]);
      }
      return is_in_face;
    }));
  }
}

TEST(HardRaysAre, FromSurfacesAndBoxCorners) {
  const Encounter scene;
  const auto from_surfaces = scene.rays(RayKind::FROM_SURFACES);
  int before = 0;
  for (const Ray& ray : from_surfaces) {
    double least = 1;
    for (const Triangle& triangle : scene.triangles) {
      const ExactMeeting meeting = exact_meeting(triangle, ray);
      if (!meeting.meets || std::abs(meeting.t) > std::abs(least)) continue;
      least = meeting.t;
    }
    EXPECT_LT(std::abs(least), 1e-4);
    before += least < 0;
  }
  EXPECT_GT(before, 50);
  EXPECT_LT(before, 250);
  for (const Ray& ray : scene.rays(RayKind::FROM_BOX_CORNERS)) {
    EXPECT_TRUE(std::ranges::any_of(scene.nodes, [&](const Node& node) {
      bool is_corner = true;
      for (int axis = 0; axis < 3; ++axis) {
        const float x = ray.origin[axis];
        is_corner &= x == node.box_min[axis] || x == node.box_max[axis];
      }
      return is_corner;
    }));
  }
}

TEST(HardRaysAre, AxisParallelWithZerosOfBothSigns) {
  int negative = 0;
  for (const Ray& ray : Encounter().rays(RayKind::AXIS_PARALLEL)) {
    int zeros = 0;
    for (int axis = 0; axis < 3; ++axis) {
      zeros += ray.direction[axis] == 0.0f;
      negative += ray.direction[axis] == 0.0f && std::signbit(ray.direction[axis]);
    }
    EXPECT_TRUE(zeros == 1 || zeros == 2);
  }
  EXPECT_GT(negative, 100);
}

TEST(HardRaysAre, DenormalInOneTwoOrAllComponents) {
  std::array<int, 4> counts{};
  for (const Ray& ray : Encounter().rays(RayKind::DENORMAL)) {
    int denormal = 0;
    for (int axis = 0; axis < 3; ++axis) denormal += is_denormal(ray.direction[axis]);
    ++counts[static_cast<std::size_t>(denormal)];
  }
  EXPECT_EQ(counts[0], 0);
  for (int denormal = 1; denormal <= 3; ++denormal) EXPECT_GT(counts[static_cast<std::size_t>(denormal)], 50);
}

TEST(HardRaysAre, WithRangesOfEverySort) {
  const auto rays = Encounter().rays(RayKind::RANGES);
  EXPECT_GT(count_rays(rays, [](const Ray& ray) { return ray.t_min > ray.t_max; }), 30);
  EXPECT_GT(count_rays(rays, [](const Ray& ray) { return ray.t_min == ray.t_max; }), 10);
  EXPECT_GT(count_rays(rays, [](const Ray& ray) { return std::isinf(ray.t_min); }), 10);
  EXPECT_GT(count_rays(rays, [](const Ray& ray) { return std::isinf(ray.t_max); }), 30);
  EXPECT_GT(count_rays(rays, [](const Ray& ray) { return ray.t_max == FLT_MIN; }), 5);
}

TEST(HardRaysAre, FarOrOfOddLength) {
  const Encounter scene;
  for (const Ray& ray : scene.rays(RayKind::FAR_ORIGINS)) EXPECT_GT(glm::length(ray.origin), 0.9e7f);
  int long_ones = 0;
  for (const Ray& ray : scene.rays(RayKind::LENGTHS)) {
    const double length = glm::length(glm::dvec3(ray.direction));
    EXPECT_TRUE(std::abs(length / 1e30 - 1) < 1e-6 || std::abs(length / 1e-30 - 1) < 1e-6) << length;
    long_ones += length > 1;
  }
  EXPECT_GT(long_ones, 100);
  EXPECT_LT(long_ones, 200);
}

TEST(InsideRays, HitAClosedMeshEach) {
  Scene scene;
  Random random(1);
  append_rock(scene, vec3(3, 4, 5), vec3(1, 2, 1.5f), random, 0);
  const std::vector<Triangle> triangles = triangles_of(scene);
  const Bvh bvh = build_ploc(triangles);
  const auto rays = inside_rays(vec3(3, 4, 5), triangles, 3000, 1);
  std::vector<Hit> hits(rays.size());
  trace_all(bvh.nodes, triangles, rays, hits);
  EXPECT_TRUE(std::ranges::all_of(hits, [](const Hit& hit) { return hit.triangle != NO_TRIANGLE; }));
  EXPECT_EQ(judge_hits(bvh.nodes, triangles, rays, hits).exact_hits, rays.size());
}

TEST(InsideRays, AreNoneWithoutAnActiveTriangle) { EXPECT_TRUE(inside_rays(vec3(0), {}, 10, 1).empty()); }

}  // namespace
}  // namespace coppice
