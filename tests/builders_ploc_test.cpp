#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "analysis/validate.h"
#include "builders/ploc.h"
#include "builders/ploc_neighbours.h"
#include "scene/random.h"
#include "support/triangles.h"

namespace coppice {
namespace {

std::uint32_t ceil_log2(std::uint32_t count) { return static_cast<std::uint32_t>(std::bit_width(count - 1)); }

void expect_valid(const Bvh& bvh, const std::vector<Triangle>& triangles) {
  EXPECT_EQ(find_fault(bvh.nodes, triangles).value_or("no fault"), "no fault");
  if (bvh.nodes.empty()) return;
  EXPECT_LE(bvh.nodes[0].height, bvh.rounds);
}

TEST(BuildPloc, GivesNoNodesForNoTriangles) {
  const Bvh bvh = build_ploc({});
  EXPECT_TRUE(bvh.nodes.empty());
  EXPECT_EQ(bvh.active_count, 0u);
  EXPECT_EQ(bvh.rounds, 0u);
}

TEST(BuildPloc, MakesOneTriangleTheRoot) {
  const std::vector<Triangle> triangles = random_soup(1, 1);
  const Bvh bvh = build_ploc(triangles);
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_EQ(bvh.nodes[0].height, 0u);
  EXPECT_EQ(bvh.nodes[0].child, 0u);
  EXPECT_EQ(bvh.rounds, 0u);
  expect_valid(bvh, triangles);
}

TEST(BuildPloc, MergesTwoTrianglesInOneRound) {
  const std::vector<Triangle> triangles = slices_at({1, 0});
  const Bvh bvh = build_ploc(triangles);
  ASSERT_EQ(bvh.nodes.size(), 3u);
  EXPECT_EQ(bvh.nodes[0].child, 1u);
  EXPECT_EQ(bvh.nodes[1].child, 1u) << "Morton order comes before triangle order";
  EXPECT_EQ(bvh.nodes[2].child, 0u);
  EXPECT_EQ(bvh.rounds, 1u);
  expect_valid(bvh, triangles);
}

TEST(BuildPloc, WritesTheFirstMergeToTheEndOfTheNodes) {
  const std::vector<Triangle> triangles = slices_at({0, 10, 11});
  const Bvh bvh = build_ploc(triangles);
  ASSERT_EQ(bvh.nodes.size(), 5u);
  EXPECT_EQ(bvh.nodes[3].child, 1u);
  EXPECT_EQ(bvh.nodes[4].child, 2u);
  EXPECT_EQ(bvh.nodes[1].child, 0u);
  EXPECT_EQ(bvh.nodes[2].child, 3u);
  EXPECT_EQ(bvh.nodes[2].height, 1u);
  EXPECT_EQ(bvh.rounds, 2u);
  expect_valid(bvh, triangles);
}

TEST(BuildPloc, LeavesInactiveTrianglesOut) {
  std::vector<Triangle> triangles = random_soup(50, 2);
  triangles[0].a.x = std::numeric_limits<float>::quiet_NaN();
  triangles[17].b.y = std::numeric_limits<float>::infinity();
  triangles[49].c.z = -std::numeric_limits<float>::infinity();
  const Bvh bvh = build_ploc(triangles);
  EXPECT_EQ(bvh.active_count, 47u);
  expect_valid(bvh, triangles);
}

TEST(BuildPloc, GivesNoNodesWhereAllTrianglesAreInactive) {
  const vec3 nowhere(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(build_ploc(std::vector<Triangle>(3, Triangle{nowhere, nowhere, nowhere})).nodes.empty());
}

TEST(BuildPloc, HalvesCoincidentTrianglesEachRound) {
  const std::vector<Triangle> triangles(100000, Triangle{vec3(1, 2, 3), vec3(2, 2, 3), vec3(1, 3, 4)});
  const Bvh bvh = build_ploc(triangles);
  EXPECT_EQ(bvh.rounds, 17u);
  expect_valid(bvh, triangles);
}

TEST(BuildPloc, TakesCoincidentPoints) {
  const std::vector<Triangle> triangles(1000, Triangle{vec3(0), vec3(0), vec3(0)});
  const Bvh bvh = build_ploc(triangles);
  EXPECT_EQ(bvh.rounds, 10u);
  expect_valid(bvh, triangles);
}

TEST(BuildPloc, NeedsFewRoundsWhereGapsShrinkSlowly) {
  constexpr std::uint32_t COUNT = 4096;
  std::vector<float> xs;
  for (std::uint32_t i = 0; i < COUNT; ++i) xs.push_back(static_cast<float>(i * (2 * COUNT - i)));
  const std::vector<Triangle> triangles = slices_at(xs);
  const Bvh bvh = build_ploc(triangles);
  EXPECT_LE(bvh.rounds, 16 * ceil_log2(COUNT));
  expect_valid(bvh, triangles);
}

TEST(BuildPloc, GivesTheSameTreeInAnyUnitOfLength) {
  const std::vector<Triangle> triangles = random_soup(500, 3);
  const Bvh bvh = build_ploc(triangles);
  for (const float unit : {0x1p-60f, 0x1p-20f, 0x1p+60f, 0x1p+120f}) {
    std::vector<Triangle> scaled;
    for (const Triangle& t : triangles) scaled.push_back({t.a * unit, t.b * unit, t.c * unit});
    const Bvh scaled_bvh = build_ploc(scaled);
    expect_valid(scaled_bvh, scaled);
    ASSERT_EQ(scaled_bvh.nodes.size(), bvh.nodes.size());
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i)
      EXPECT_EQ(scaled_bvh.nodes[i].child, bvh.nodes[i].child);
  }
}

TEST(BuildPloc, TakesTheWholeRangeOfFloat) {
  std::vector<Triangle> triangles = random_soup(200, 4);
  const float largest = std::numeric_limits<float>::max();
  const float smallest = std::numeric_limits<float>::min();
  triangles.push_back({vec3(-largest), vec3(largest), vec3(smallest)});
  triangles.push_back({vec3(smallest), vec3(smallest), vec3(smallest)});
  triangles.push_back({vec3(largest), vec3(largest), vec3(largest)});
  expect_valid(build_ploc(triangles), triangles);
}

TEST(BuildPloc, RefusesARadiusOutOfRange) {
  EXPECT_THROW(build_ploc({}, {.radius = 0}), std::invalid_argument);
  EXPECT_THROW(build_ploc({}, {.radius = PLOC_MAX_RADIUS + 1}), std::invalid_argument);
}

TEST(BuildPloc, RefusesMortonCodesOfOtherThan30Or60Bits) {
  EXPECT_THROW(build_ploc({}, {.morton_bits = 0}), std::invalid_argument);
  EXPECT_THROW(build_ploc({}, {.morton_bits = 63}), std::invalid_argument);
}

class BuildPlocOfSoup
    : public testing::TestWithParam<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> {};

TEST_P(BuildPlocOfSoup, IsAValidTreeNoDeeperThanItsRounds) {
  const auto [count, radius, morton_bits] = GetParam();
  const std::vector<Triangle> triangles = random_soup(count, count);
  const Bvh bvh = build_ploc(triangles, {radius, morton_bits});
  EXPECT_EQ(bvh.active_count, count);
  expect_valid(bvh, triangles);
}

INSTANTIATE_TEST_SUITE_P(SizesRadiiAndBits, BuildPlocOfSoup,
                         testing::Combine(testing::Values(2, 3, 4, 5, 33, 255, 256, 257, 20000),
                                          testing::Values(1, 2, 16, 100), testing::Values(30, 60)));

// The definition, literally.
std::uint32_t nearest_by_definition(const std::vector<Aabb>& boxes, std::uint32_t i, std::uint32_t radius) {
  const auto count = static_cast<std::uint32_t>(boxes.size());
  auto least = std::make_tuple(std::numeric_limits<float>::infinity(), 0u, 0u);
  std::uint32_t nearest = i;
  for (std::uint32_t j = i < radius ? 0 : i - radius; j < std::min(count, i + radius + 1); ++j) {
    if (j == i) continue;
    float e[3];
    for (int axis = 0; axis < 3; ++axis) {
      e[axis] = std::max(boxes[i].box_max[axis], boxes[j].box_max[axis]) -
                std::min(boxes[i].box_min[axis], boxes[j].box_min[axis]);
    }
    const float area = (e[0] * e[1] + e[1] * e[2]) + e[2] * e[0];
    const std::uint32_t gap = i > j ? i - j : j - i;
    const std::uint32_t bit = std::min(i, j) >> std::countr_zero(gap) & 1;
    const auto key = std::make_tuple(area, gap, bit);
    if (key < least) {
      least = key;
      nearest = j;
    }
  }
  return nearest;
}

// Corners on a grid of 0 to `cells` along each axis: the fewer cells, the more ties.
std::vector<Aabb> boxes_on_grid(std::uint32_t count, std::uint32_t cells) {
  Random random(count * 31 + cells);
  std::vector<Aabb> boxes(count);
  for (Aabb& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<float>(random.below(cells + 1));
      const auto b = static_cast<float>(random.below(cells + 1));
      box.box_min[axis] = std::min(a, b);
      box.box_max[axis] = std::max(a, b);
    }
  }
  return boxes;
}

class NearestNeighbours : public testing::TestWithParam<std::tuple<std::uint32_t, std::uint32_t>> {
 protected:
  static constexpr std::uint32_t COUNTS[] = {2, 3, 5, 31, 255, 256, 257, 600};

  static void expect_as_defined(const ClusterBoxes& clusters, const std::vector<Aabb>& boxes,
                                std::uint32_t radius) {
    std::vector<std::uint32_t> nearest(boxes.size());
    clusters.find_nearest(nearest);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      ASSERT_EQ(nearest[i], nearest_by_definition(boxes, i, radius)) << i << " of " << boxes.size();
    }
  }
};

TEST_P(NearestNeighbours, AreThoseOfTheDefinition) {
  const auto [radius, cells] = GetParam();
  for (const std::uint32_t count : COUNTS) {
    const std::vector<Aabb> boxes = boxes_on_grid(count, cells);
    expect_as_defined(ClusterBoxes(boxes, radius), boxes, radius);
  }
}

TEST_P(NearestNeighbours, ForgetClustersThatAreGone) {
  const auto [radius, cells] = GetParam();
  for (const std::uint32_t count : COUNTS) {
    std::vector<Aabb> boxes = boxes_on_grid(count + 7, cells);
    ClusterBoxes clusters(boxes, radius);
    clusters.shrink(count);
    boxes.resize(count);
    expect_as_defined(clusters, boxes, radius);
  }
}

INSTANTIATE_TEST_SUITE_P(RadiiAndGrids, NearestNeighbours,
                         testing::Combine(testing::Values(1, 2, 3, 4, 8, 16, 99, 100),
                                          testing::Values(0, 1, 3, 1000)));

}  // namespace
}  // namespace coppice
