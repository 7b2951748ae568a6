#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/triangulate.h"

namespace coppice {
namespace {

double area(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles) {
  double sum = 0;
  for (const glm::uvec3 t : triangles) {
    const glm::vec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
    const double twice = double{b.x - a.x} * (c.y - a.y) - double{b.y - a.y} * (c.x - a.x);
    EXPECT_GE(twice, 0) << "a triangle is turned over";
    sum += twice / 2;
  }
  return sum;
}

std::vector<glm::uvec3> cut(const std::vector<glm::vec3>& polygon) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < polygon.size(); ++i) indices.push_back(i);
  std::vector<glm::uvec3> triangles;
  triangulate(polygon, indices, triangles);
  EXPECT_EQ(triangles.size(), polygon.size() - 2);
  return triangles;
}

TEST(Triangulate, CoversAConvexPolygon) {
  const std::vector<glm::vec3> hexagon = {{1, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 1, 0}};
  EXPECT_DOUBLE_EQ(area(hexagon, cut(hexagon)), 4);
}

TEST(Triangulate, CoversAConcavePolygonFromEveryCorner) {
  std::vector<glm::vec3> letter = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0},
                                   {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  for (std::size_t start = 0; start < letter.size(); ++start) {
    EXPECT_DOUBLE_EQ(area(letter, cut(letter)), 7) << "from corner " << start;
    std::rotate(letter.begin(), letter.begin() + 1, letter.end());
  }
}

TEST(Triangulate, CoversAConcaveQuad) {
  std::vector<glm::vec3> arrow = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
  for (int start = 0; start < 4; ++start) {
    EXPECT_DOUBLE_EQ(area(arrow, cut(arrow)), 4);
    std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
  }
}

TEST(Triangulate, LosesNoTriangleOfPolygonsWithoutACut) {
  cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});                      // bow tie
  cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}});           // flat
  cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});                      // a point
  cut({{0, 0, 0}, {NAN, 1, 0}, {1, 0, 0}, {0, INFINITY, 0}, {0, 0, 1}});  // not finite
  cut({{-3e38f, -3e38f, 0}, {3e38f, -3e38f, 0}, {3e38f, 3e38f, 0}, {0, 0, 0}, {-3e38f, 3e38f, 0}});
}

}  // namespace
}  // namespace coppice
