// Hard cases of odd shapes and index buffers, and closed meshes: the property that each is named for.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <vector>

#include "analysis/cpu_tracer.h"
#include "builders/leaves.h"
#include "scene/hard_cases.h"
#include "scene/random.h"
#include "support/scenes.h"
#include "support/triangles.h"

namespace coppice {
namespace {

vec3 extent(const Triangle& t) {
  const Aabb box = triangle_box(t);
  return box.box_max - box.box_min;
}

double area(const Triangle& t) {
  return 0.5 * glm::length(glm::cross(glm::dvec3(t.b) - glm::dvec3(t.a), glm::dvec3(t.c) - glm::dvec3(t.a)));
}

using PointKey = std::tuple<float, float, float>;
PointKey place(vec3 p) { return {p.x, p.y, p.z}; }

// How often each directed edge occurs, where `vertex` names the corner of an index.
template <class Vertex>
auto count_edges(const Scene& scene, const Vertex& vertex) {
  using Name = decltype(vertex(0u));
  std::map<std::pair<Name, Name>, int> counts;
  for (const glm::uvec3 t : scene.indices) {
    for (int corner = 0; corner < 3; ++corner) ++counts[{vertex(t[corner]), vertex(t[(corner + 1) % 3])}];
  }
  return counts;
}

TEST(HardShapes, ThePlanarGridHasNoExtentAcross) {
  for (const Triangle& t : triangles_of(make_hard_case("planar-grid", 1000))) {
    EXPECT_EQ(extent(t).y, 0);
    EXPECT_GT(area(t), 0);
  }
}

TEST(HardShapes, PointsAndSegmentsHaveNoArea) {
  const auto triangles = triangles_of(make_hard_case("points", 1000));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    EXPECT_EQ(area(triangles[i]), 0);
    EXPECT_EQ(extent(triangles[i]) == vec3(0), i % 2 == 0);
  }
}

TEST(HardShapes, NeedlesAreLongAndHaveAlmostNoArea) {
  int without_area = 0;
  for (const Triangle& t : triangles_of(make_hard_case("needles", 10'000))) {
    EXPECT_NEAR(glm::length(t.b - t.a), 10, 1e-4);
    EXPECT_LT(area(t), 2e-5);
    without_area += area(t) == 0;
  }
  EXPECT_GT(without_area, 0);
  EXPECT_LT(without_area, 5000);
}

TEST(HardShapes, TheBoxOfADiagonalIsAlmostTheWholeScene) {
  for (const Triangle& t : triangles_of(make_hard_case("diagonals", 1000))) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_GT(extent(t)[axis], 0.97f * 202);
    EXPECT_LT(area(t), 4);
  }
}

TEST(HardShapes, OneHugeTriangleIsOverAllTinyOnes) {
  const auto triangles = triangles_of(make_hard_case("huge-over-tiny", 1001));
  const Triangle& huge = triangles.front();
  const auto side = [](vec3 a, vec3 b, vec3 p) {
    return (b.x - a.x) * (p.z - a.z) - (b.z - a.z) * (p.x - a.x);
  };
  for (std::size_t i = 1; i < triangles.size(); ++i) {
    const vec3 p = triangles[i].a;
    EXPECT_LT(p.y, 0.5f);
    EXPECT_TRUE(side(huge.a, huge.b, p) > 0 && side(huge.b, huge.c, p) > 0 && side(huge.c, huge.a, p) > 0);
    EXPECT_GT(area(huge), 1e8 * area(triangles[i]));
  }
}

TEST(HardShapes, PairsShareAnEdge) {
  const Scene scene = make_hard_case("edge-pairs", 101);
  for (std::size_t i = 0; i + 1 < scene.indices.size(); i += 2) {
    const glm::uvec3 t = scene.indices[i], u = scene.indices[i + 1];
    EXPECT_TRUE(t.x == u.y && t.y == u.x && t.z != u.z);
    const vec3 apex = scene.positions[t.z], other = scene.positions[u.z], edge = scene.positions[t.x];
    EXPECT_EQ(glm::dot(apex - edge, other - edge), i / 2 % 2 == 0 ? -0.75f : 0.25f);
    EXPECT_EQ(edge, vec3(0, 0, static_cast<float>(i / 2)));
  }
}

TEST(HardShapes, TheDyadicGridIsExactAndWithoutTJunctions) {
  for (const std::uint32_t count : {1u, 2u, 3u, 50u, 1001u, 10'000u}) {
    const Scene scene = make_hard_case("dyadic-grid", count);
    for (const vec3 p : scene.positions) EXPECT_EQ(p * 256.0f, glm::floor(p * 256.0f));
    std::set<PointKey> places;
    for (const vec3 p : scene.positions) places.insert(place(p));
    EXPECT_EQ(places.size(), scene.positions.size());
    // Every triangle is half a cell, and every edge inside is that of two: nothing can lie on an edge.
    for (const Triangle& t : triangles_of(scene))
      EXPECT_EQ((t.c.x - t.a.x) * (t.b.z - t.a.z) - (t.b.x - t.a.x) * (t.c.z - t.a.z), 1.0f / 256);
    std::size_t open_edges = 0;
    const auto edges = count_edges(scene, [](std::uint32_t index) { return index; });
    for (const auto& [edge, times] : edges) {
      ASSERT_EQ(times, 1);
      open_edges += !edges.contains({edge.second, edge.first});
    }
    EXPECT_LE(static_cast<double>(open_edges), 6 * std::sqrt(count) + 6);  // the border alone
  }
}

TEST(HardShapes, IndicesRepeatWithinTriangles) {
  std::map<std::size_t, int> distinct;
  std::map<std::uint32_t, int> uses;
  for (const glm::uvec3 t : make_hard_case("repeated-indices", 1000).indices) {
    ++distinct[std::set{t.x, t.y, t.z}.size()];
    for (int corner = 0; corner < 3; ++corner) ++uses[t[corner]];
  }
  EXPECT_EQ(distinct, (std::map<std::size_t, int>{{1, 200}, {2, 600}, {3, 200}}));
  EXPECT_LT(uses.size(), 504u);
}

TEST(HardShapes, PositionsRepeatUnderSeveralIndices) {
  const Scene scene = make_hard_case("repeated-positions", 1000);
  std::set<PointKey> places;
  for (const vec3 p : scene.positions) places.insert(place(p));
  EXPECT_EQ(scene.positions.size(), 3000u);
  EXPECT_LT(places.size(), 600u);
}

// --- Closed meshes.

class ClosedMesh : public testing::TestWithParam<HardCase> {
 protected:
  static vec3 centre_of(const Scene& scene) {
    vec3 low = scene.positions.front(), high = low;
    for (const vec3 p : scene.positions) low = glm::min(low, p), high = glm::max(high, p);
    return 0.5f * (low + high);
  }
  static constexpr std::array<std::uint32_t, 13> sizes = {0,  13, 14,  15,   16,     17,     18,
                                                          20, 99, 256, 1001, 10'000, 100'000};
};

TEST_P(ClosedMesh, HasAnEvenCountNextToTheOneAskedFor) {
  EXPECT_EQ(GetParam().triangle_count(0), LEAST_CLOSED_TRIANGLES);
  EXPECT_EQ(GetParam().triangle_count(99), 100u);
  for (const std::uint32_t size : sizes)
    EXPECT_EQ(GetParam().make(size, 1).indices.size(), GetParam().triangle_count(size)) << size;
}

template <class Edges>
void expect_manifold(const Edges& edges, std::uint32_t triangle_count) {
  EXPECT_EQ(edges.size(), std::size_t{triangle_count} * 3);
  for (const auto& [edge, times] : edges) {
    ASSERT_EQ(times, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
    ASSERT_NE(edge.first, edge.second);
  }
}

TEST_P(ClosedMesh, EveryEdgeBelongsToTwoTrianglesByIndexAndByPlace) {
  for (const std::uint32_t size : sizes) {
    const Scene scene = GetParam().make(size, 1);
    const std::uint32_t count = GetParam().triangle_count(size);
    expect_manifold(count_edges(scene, [](std::uint32_t index) { return index; }), count);
    expect_manifold(count_edges(scene, [&](std::uint32_t index) { return place(scene.positions[index]); }),
                    count);
    EXPECT_EQ(scene.positions.size(), count / 2 + 2) << size;  // Euler: in one piece, without holes
  }
}

// The solid angle of a triangle, positive where it is seen from behind (van Oosterom and Strackee 1983).
double solid_angle(const Triangle& t, vec3 from) {
  const glm::dvec3 a = glm::normalize(glm::dvec3(t.a) - glm::dvec3(from));
  const glm::dvec3 b = glm::normalize(glm::dvec3(t.b) - glm::dvec3(from));
  const glm::dvec3 c = glm::normalize(glm::dvec3(t.c) - glm::dvec3(from));
  const double cosines = 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a);
  return 2 * std::atan2(glm::dot(a, glm::cross(b, c)), cosines);
}

TEST_P(ClosedMesh, TheCentreIsInsideAndNotNearAnyTriangle) {
  for (const std::uint32_t size : sizes) {
    for (const std::uint64_t seed : {1ull, 2ull, 3ull}) {
      const Scene scene = GetParam().make(size, seed);
      const vec3 centre = centre_of(scene);
      double sum = 0;
      for (const Triangle& t : triangles_of(scene)) {
        const double angle = solid_angle(t, centre);
        ASSERT_LT(std::abs(angle), 6) << "almost half of what is to be seen, of " << 2 * std::numbers::pi;
        sum += angle;
      }
      EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-6) << size;
    }
  }
}

TEST_P(ClosedMesh, EveryRayFromTheCentreHits) {
  for (const std::uint32_t size : {14u, 17u, 100u, 2000u}) {
    const Scene scene = GetParam().make(size, 1);
    const auto triangles = triangles_of(scene);
    const vec3 centre = centre_of(scene);
    std::vector<Ray> rays;
    Random random(5);
    for (int i = 0; i < 2000; ++i)
      rays.push_back({centre, 0, random.direction(), std::numeric_limits<float>::infinity()});
    // Through the middles of edges, as nearly as a direction can say it. (Not through vertices: the tracer in
    // double may lose a ray there to rounding.)
    for (const Triangle& t : triangles)
      rays.push_back({centre, 0, 0.5f * (t.a + t.b) - centre, std::numeric_limits<float>::infinity()});
    std::vector<Hit> hits(rays.size());
    trace_all({}, triangles, rays, hits);
    for (std::size_t i = 0; i < hits.size(); ++i)
      EXPECT_NE(hits[i].triangle, NO_TRIANGLE) << size << " " << i;
  }
}

std::vector<HardCase> closed_cases() {
  std::vector<HardCase> closed;
  for (const HardCase& hard_case : hard_cases()) {
    if (hard_case.closed) closed.push_back(hard_case);
  }
  return closed;
}

INSTANTIATE_TEST_SUITE_P(All, ClosedMesh, testing::ValuesIn(closed_cases()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace coppice
