#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numeric>
#include <vector>

#include "scene/orientation.h"
#include "scene/sweep_polygon.h"
#include "scene/triangulate.h"
#include "support/outlines.h"

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

struct Cut {
  std::vector<glm::uvec3> triangles;
  bool is_whole;
};

Cut cut_any(const std::vector<glm::vec3>& polygon) {
  std::vector<std::uint32_t> indices(polygon.size());
  std::iota(indices.begin(), indices.end(), 0u);
  Cut cut;
  cut.is_whole = triangulate(polygon, indices, cut.triangles);
  EXPECT_EQ(cut.triangles.size(), polygon.size() - 2);
  return cut;
}

std::vector<glm::uvec3> cut(const std::vector<glm::vec3>& polygon) {
  Cut result = cut_any(polygon);
  EXPECT_TRUE(result.is_whole);
  return std::move(result.triangles);
}

TEST(Orientation, IsExactWhereDoubleIsNot) {
  const float e = std::ldexp(1.0f, -24);
  EXPECT_EQ(orientation({0.5f, 0.5f}, {12, 12}, {24, 24}), 0);
  EXPECT_EQ(orientation({0.5f, 0.5f + e}, {12, 12}, {24, 24}), 1);
  EXPECT_EQ(orientation({0.5f + e, 0.5f}, {12, 12}, {24, 24}), -1);
  // One part in 2^100 of the products decides.
  EXPECT_EQ(orientation({0x1p-100f, 0}, {0x1p20f, 0x1p20f}, {-0x1p20f, -0x1p20f}), 1);
  EXPECT_EQ(orientation({-0x1p-100f, 0}, {0x1p20f, 0x1p20f}, {-0x1p20f, -0x1p20f}), -1);
  EXPECT_EQ(orientation({0x1p-149f, 0}, {0x1p-149f, 0x1p-149f}, {0, 0}), 1);
  EXPECT_EQ(orientation({-3e38f, -3e38f}, {3e38f, -3e38f}, {3e38f, 3e38f}), 1);
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

TEST(Triangulate, ACornerThatStandsTwiceHidesNoReflexAngle) {
  for (int times = 2; times < 5; ++times) {
    std::vector<glm::vec3> arrow = {{4, 0, 0}};
    arrow.insert(arrow.end(), static_cast<std::size_t>(times), {1, 1, 0});
    arrow.insert(arrow.end(), {{0, 4, 0}, {0, 0, 0}});
    for (std::size_t start = 0; start < arrow.size(); ++start) {
      EXPECT_DOUBLE_EQ(area(arrow, cut(arrow)), 4);
      std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
    }
  }
}

TEST(Triangulate, LosesNoTriangleOfPolygonsWithoutAnArea) {
  cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}});             // flat
  cut({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {3, 0, 0}, {0, 0, 0}, {1, 0, 0}});  // flat, to and fro
  cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});                        // a point
}

TEST(Triangulate, SaysWhereEdgesCross) {
  EXPECT_FALSE(cut_any({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).is_whole);  // bow tie
  EXPECT_FALSE(cut_any({{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 2, 0}}).is_whole);
  // A star of five points in one stroke, which winds twice around its middle.
  EXPECT_FALSE(cut_any({{0, 3, 0}, {-2, -3, 0}, {3, 1, 0}, {-3, 1, 0}, {2, -3, 0}}).is_whole);
}

TEST(Triangulate, CoversBothHalvesOfAnEightWithACornerInItsMiddle) {
  const std::vector<glm::vec3> eight = {{0, 0, 0}, {2, 1, 0}, {2, -1, 0}, {0, 0, 0}, {-3, 1, 0}, {-3, -1, 0}};
  double sum = 0;
  for (const glm::uvec3 t : cut(eight)) {
    const glm::vec3 a = eight[t.x], b = eight[t.y], c = eight[t.z];
    sum += std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  }
  EXPECT_DOUBLE_EQ(sum, 5);
}

TEST(Triangulate, APolygonWithABrokenCornerIsBrokenAsAWhole) {
  std::vector<glm::vec3> polygon = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {-1, 1, 0}};
  for (const float broken : {NAN, INFINITY}) {
    for (std::uint32_t corner = 0; corner < polygon.size(); ++corner) {
      std::vector<glm::vec3> changed = polygon;
      changed[corner].y = broken;
      for (const glm::uvec3 t : cut(changed)) EXPECT_TRUE(t.x == corner || t.y == corner || t.z == corner);
    }
  }
}

TEST(Triangulate, TakesAllOfFloatsRange) {
  for (const float size : {3e38f, 1e-38f, 4e-45f}) {
    const std::vector<glm::vec3> arrow = {
        {-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {0, 0, 0}, {-size, size, 0}};
    double sum = 0;
    for (const glm::uvec3 t : cut(arrow)) {
      const glm::dvec3 a = arrow[t.x], b = arrow[t.y], c = arrow[t.z];
      sum += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    }
    EXPECT_DOUBLE_EQ(sum, 3.0 * size * size);
  }
}

TEST(Triangulate, SearchesNoLongerThanBoundedForWhatIsNotThere) {
  Random random(3);
  std::vector<glm::vec3> scribble;
  for (int i = 0; i < 20'000; ++i) scribble.push_back(random.in_cube());
  EXPECT_FALSE(cut_any(scribble).is_whole);
}

Outline random_outline(Random& random) {
  switch (random.below(4)) {
    case 0:
      return star_outline(random, 3 + random.below(18));
    case 1:
      return blocks_outline(random, 40);
    case 2:
      return holes_outline(random, random.below(5));
    default:
      return comb_outline(random, 1 + random.below(5));
  }
}

// Edges that meant to lie on each other are apart by a rounding, so that they cross or enclose slivers.
TEST(Triangulate, IsNotMisledByRoundedCorners) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const Outline outline = decorated(random_outline(random), random);
    const glm::vec2 turned = turn_to_circle(random.uniform());
    std::vector<glm::vec3> positions;
    for (const glm::vec2 p : outline) {
      positions.emplace_back(turned.x * p.x - turned.y * p.y + 0.1f, turned.y * p.x + turned.x * p.y, 0);
    }
    double sum = 0;
    for (const glm::uvec3 t : cut(positions)) {
      const glm::dvec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
      sum += std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }
    const double expected = static_cast<double>(twice_area(outline)) * glm::dot(turned, turned);
    ASSERT_NEAR(sum, expected, 1e-3 * expected) << "outline " << i;
  }
}

// The corners of an outline in space: any two axes, either winding, all sizes, and a third coordinate that is
// no plane's, but so little that the outline's area is still the greatest on its own two axes.
std::vector<glm::vec3> in_space(const Outline& outline, Random& random) {
  const int u = static_cast<int>(random.below(3)), v = (u + 1) % 3, w = (u + 2) % 3;
  const float scale = std::ldexp(1.0f, static_cast<int>(random.below(200)) - 100);
  const int x = static_cast<int>(random.below(1u << 16)), y = static_cast<int>(random.below(1u << 16));
  double length = 1;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::ivec2 edge = outline[i] - outline[(i + 1) % outline.size()];
    length += std::abs(edge.x) + std::abs(edge.y);
  }
  const float height = random.below(2) == 0 ? 0 : static_cast<float>(twice_area(outline) / (16 * length));
  std::vector<glm::vec3> positions;
  for (const glm::ivec2 p : outline) {
    glm::vec3 position;
    position[u] = static_cast<float>(p.x + x) * scale;
    position[v] = static_cast<float>(p.y + y) * scale;
    position[w] = random.uniform(-height, height) * scale;
    positions.push_back(position);
  }
  return positions;
}

// Whether all triangles have `side` as their winding or no area, and the area of the outline in all.
testing::AssertionResult covers(const std::vector<glm::uvec3>& triangles, const Outline& outline, int side) {
  std::int64_t sum = 0;
  for (const glm::uvec3 t : triangles) {
    const std::int64_t twice = side * cross(outline[t.y] - outline[t.x], outline[t.z] - outline[t.x]);
    if (twice < 0) return testing::AssertionFailure() << "a triangle is turned over";
    sum += twice;
  }
  if (sum == twice_area(outline)) return testing::AssertionSuccess();
  auto failure = testing::AssertionFailure() << sum << " in place of " << twice_area(outline) << ":";
  for (const glm::ivec2 p : outline) failure << " (" << p.x << "," << p.y << ")";
  return failure;
}

TEST(Triangulate, CoversRandomOutlines) {
#ifdef COPPICE_SANITIZED
  constexpr int count = 10'000;
#else
  constexpr int count = 100'000;
#endif
  Random random(1);
  for (int i = 0; i < count; ++i) {
    Outline outline = random_outline(random);
    if (i % 2 == 0) outline = decorated(outline, random);
    std::rotate(outline.begin(), outline.begin() + random.below(static_cast<std::uint32_t>(outline.size())),
                outline.end());
    std::vector<std::uint32_t> indices(outline.size());
    std::iota(indices.begin(), indices.end(), 0u);
    const int side = random.below(2) == 0 ? 1 : -1;
    if (side < 0) std::ranges::reverse(indices);
    std::vector<glm::uvec3> triangles;
    ASSERT_TRUE(triangulate(in_space(outline, random), indices, triangles)) << "outline " << i;
    ASSERT_EQ(triangles.size(), outline.size() - 2) << "outline " << i;
    ASSERT_TRUE(covers(triangles, outline, side)) << "outline " << i;

    // The sweep alone, which small outlines rarely need.
    std::vector<glm::vec2> flat;
    for (const glm::ivec2 p : outline) flat.emplace_back(p.x, p.y);
    triangles.clear();
    ASSERT_TRUE(sweep_polygon(flat, triangles)) << "outline " << i;
    ASSERT_LE(triangles.size(), outline.size() - 2) << "outline " << i;
    ASSERT_TRUE(covers(triangles, outline, 1)) << "outline " << i;
  }
}

// How often the outline winds around a point that is on no edge: what a ray to the right crosses.
int winding_around(const Outline& outline, glm::ivec2 point) {
  int winding = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::ivec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    if ((a.y < point.y) == (b.y < point.y)) continue;
    const std::int64_t side = cross(b - a, point - a);
    if (a.y < b.y ? side > 0 : side < 0) winding += a.y < b.y ? 1 : -1;
  }
  return winding;
}

bool edges_cross(const Outline& outline) {
  const auto side = [](glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
    const std::int64_t area = cross(b - a, c - a);
    return (area > 0) - (area < 0);
  };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const glm::ivec2 a = outline[i], b = outline[(i + 1) % outline.size()], c = outline[j],
                       d = outline[(j + 1) % outline.size()];
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  }
  return false;
}

// Random walks over few places meet themselves in every way. Where there is a cut, each point is covered as
// often as the outline winds around it, and there is one unless edges cross or it winds more than once.
TEST(Triangulate, CoversEachPointAsOftenAsTheOutlineWindsAroundIt) {
  Random random(5);
  int whole = 0;
  for (int i = 0; i < 30'000; ++i) {
    constexpr int unit = 1024;
    Outline outline;
    for (std::uint32_t corner = 4 + random.below(9); corner > 0; --corner) {
      const int x = static_cast<int>(random.below(4)), y = static_cast<int>(random.below(3));
      outline.emplace_back(unit * x, unit * y);
    }
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> flat;
    for (const glm::ivec2 p : outline) positions.emplace_back(p.x, p.y, 0), flat.emplace_back(p.x, p.y);
    const Cut cut = cut_any(positions);
    std::vector<glm::uvec3> swept;
    const bool crosses = edges_cross(outline);
    EXPECT_TRUE(sweep_polygon(flat, swept) || crosses) << "outline " << i;
    whole += cut.is_whole;
    bool winds_twice = false;
    const int samples = cut.is_whole || crosses ? 50 : 2000;
    for (int sample = 0; sample < samples; ++sample) {
      // Odd numbers, so on no corner's row; few are on an edge, and those may be on either side of it.
      const int x = static_cast<int>(random.below(2 * unit)) * 2 + 1,
                y = static_cast<int>(random.below(unit)) * 2 + 1;
      const int winding = winding_around(outline, {x, y});
      winds_twice = winds_twice || std::abs(winding) > 1;
      int covered = 0;
      for (const glm::uvec3 t : cut.triangles) {
        covered += winding_around({outline[t.x], outline[t.y], outline[t.z]}, {x, y});
      }
      ASSERT_TRUE(!cut.is_whole || covered == winding) << "outline " << i << " at " << x << ' ' << y;
    }
    EXPECT_TRUE(cut.is_whole || winds_twice || crosses) << "outline " << i;
  }
  EXPECT_GT(whole, 5000);
}

TEST(Triangulate, CoversLargeOutlines) {
  Random random(2);
#ifdef COPPICE_SANITIZED
  const std::vector<std::uint32_t> sizes = {1000, 10'000};
#else
  const std::vector<std::uint32_t> sizes = {1000, 10'000, 100'000};
#endif
  for (const std::uint32_t corners : sizes) {
    const Outline comb = comb_outline(random, corners / 4);
    for (const Outline& outline :
         {star_outline(random, corners), comb, holes_outline(random, corners / 7), decorated(comb, random)}) {
      std::vector<glm::vec3> lying, standing;  // along the line of the sweep and across it
      for (const glm::ivec2 p : outline) lying.emplace_back(p.x, p.y, 0), standing.emplace_back(p.y, p.x, 0);
      EXPECT_TRUE(covers(cut(lying), outline, 1)) << corners;
      EXPECT_TRUE(covers(cut(standing), outline, 1)) << corners;
    }
  }
}

}  // namespace
}  // namespace coppice
