// The builders that split top-down, and the one that merges level by level.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "analysis/quality.h"
#include "builders/bottom_up.h"
#include "builders/leaves.h"
#include "builders/sah.h"
#include "builders/sah_sweep.h"
#include "builders/subtree.h"
#include "builders/top_down.h"
#include "support/builders.h"
#include "support/triangles.h"

namespace coppice {
namespace {

// Triangle indices below the node, in the order of the leaves.
std::vector<std::uint32_t> triangles_below(const Bvh& bvh, std::uint32_t node) {
  std::vector<std::uint32_t> triangles, stack = {node};
  while (!stack.empty()) {
    const Node& top = bvh.nodes[stack.back()];
    stack.pop_back();
    if (top.height == 0) {
      triangles.push_back(top.child);
    } else {
      stack.push_back(top.child + 1);
      stack.push_back(top.child);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

using Indices = std::vector<std::uint32_t>;

// Each twice as far out as the next one: whoever splits by space splits off one at a time.
std::vector<Triangle> halving_row(std::uint32_t count) {
  std::vector<float> xs;
  for (std::uint32_t i = 0; i < count; ++i) xs.push_back(std::ldexp(1.0f, -static_cast<int>(i)));
  return slices_at(xs);
}

TEST(BuildTopDown, SplitsAtTheMiddleOfTheLongestAxis) {
  const Bvh bvh = build_top_down(slices_at({0, 8, 1, 9, 10}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child), (Indices{0, 2}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child + 1), (Indices{1, 3, 4}));
}

TEST(BuildTopDown, PutsACentreOnThePlaneAbove) {
  const Bvh bvh = build_top_down(slices_at({0, 5, 10}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child), (Indices{0}));
}

TEST(BuildTopDown, HalvesTheListWhereCentresCoincide) {
  const Bvh bvh = build_top_down(slices_at(std::vector<float>(6, 1.0f)));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child), (Indices{0, 1, 2}));
}

TEST(BuildTopDown, HalvesTheListWhereOneSideIsEmpty) {
  // The large triangle's box has its centre above the middle of no box but its own.
  std::vector<Triangle> triangles = slices_at({6, 7, 8, 9});
  triangles.push_back({vec3(0, 0, 0), vec3(10, 0, 0), vec3(10, 1, 1)});
  const Bvh bvh = build_top_down(triangles);
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child), (Indices{0, 1}));
}

TEST(BuildTopDown, PutsNodesInDepthFirstOrder) {
  const Bvh bvh = build_top_down(random_soup(300, 1));
  std::uint32_t next = 1;
  std::vector<std::uint32_t> stack = {0};
  while (!stack.empty()) {
    const Node& node = bvh.nodes[stack.back()];
    stack.pop_back();
    if (node.height == 0) continue;
    ASSERT_EQ(node.child, next);
    next += 2;
    stack.push_back(node.child + 1);
    stack.push_back(node.child);
  }
}

TEST(MustHalve, KeepsTreesWithinTheLimit) {
  EXPECT_FALSE(must_halve({0, 1, 0, 1024, SPLIT_HEIGHT_LIMIT - 11}));
  EXPECT_TRUE(must_halve({0, 1, 0, 1024, SPLIT_HEIGHT_LIMIT - 10}));
}

TEST(SplittingBuilders, KeepAChainWithinTheLimit) {
  std::vector<Triangle> triangles = halving_row(120);
  for (int i = 0; i < 400; ++i) triangles.push_back({vec3(0), vec3(0), vec3(0)});
  for (const Bvh& bvh : {build_top_down(triangles), build_sah(triangles), build_sah_sweep(triangles)}) {
    expect_valid(bvh, triangles);
    EXPECT_LE(bvh.nodes[0].height, SPLIT_HEIGHT_LIMIT);
  }
}

TEST(BuildBottomUp, MergesNeighboursInTheOrderOfTheList) {
  const Bvh bvh = build_bottom_up(slices_at({5, 0, 9, 1}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child), (Indices{0, 1}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child + 1), (Indices{2, 3}));
}

TEST(BuildBottomUp, CarriesTheOddOneToTheNextLevel) {
  const Bvh bvh = build_bottom_up(slices_at({0, 1, 2, 3, 4}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child), (Indices{0, 1, 2, 3}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child + 1), (Indices{4}));
}

TEST(BuildBottomUp, TakesAsManyRoundsAsItHasLevels) {
  const Bvh bvh = build_bottom_up(random_soup(1025, 1));
  EXPECT_EQ(bvh.rounds, 11u);
  EXPECT_EQ(bvh.nodes[0].height, 11u);
}

TEST(BuildSah, SplitsWhereTheCostIsLeast) {
  const Bvh bvh = build_sah(slices_at({0, 1, 100, 101, 102, 103}));
  EXPECT_EQ(triangles_below(bvh, bvh.nodes[0].child), (Indices{0, 1}));
}

TEST(BuildSah, GivesTheSameBitsForEveryNumberOfThreads) {
  const std::vector<Triangle> triangles = random_soup(50000, 2);
  const Bvh alone = build_sah(triangles, {1});
  for (const std::uint32_t threads : {0u, 2u, 3u, 4u}) {
    EXPECT_TRUE(same_nodes(build_sah(triangles, {threads}), alone)) << threads;
  }
}

TEST(BuildSah, GivesAValidTreeWhereThreadsShareNodes) {
  const std::vector<Triangle> triangles = random_soup(50000, 3);
  expect_valid(build_sah(triangles, {3}), triangles);
}

// Children of the root by trying every split along every axis.
double least_root_cost(const std::vector<Node>& leaves) {
  const auto half_area = [](const Aabb& box) {
    const vec3 e = box.box_max - box.box_min;
    return double{e.x} * e.y + double{e.y} * e.z + double{e.z} * e.x;
  };
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Node> order = leaves;
    std::stable_sort(order.begin(), order.end(), [&](const Node& a, const Node& b) {
      return a.box_min[axis] + a.box_max[axis] < b.box_min[axis] + b.box_max[axis];
    });
    for (std::size_t k = 1; k < order.size(); ++k) {
      const std::span<const Node> all(order);
      least = std::min(least, half_area(bounds_of(all.first(k))) * static_cast<double>(k) +
                                  half_area(bounds_of(all.subspan(k))) * static_cast<double>(all.size() - k));
    }
  }
  return least;
}

TEST(BuildSahSweep, FindsTheBestOfAllSplits) {
  const std::vector<Triangle> triangles = random_soup(100, 4);
  const Bvh bvh = build_sah_sweep(triangles);
  double cost = 0;
  for (const std::uint32_t child : {bvh.nodes[0].child, bvh.nodes[0].child + 1}) {
    const vec3 e = bvh.nodes[child].box_max - bvh.nodes[child].box_min;
    cost += (double{e.x} * e.y + double{e.y} * e.z + double{e.z} * e.x) *
            static_cast<double>(triangles_below(bvh, child).size());
  }
  EXPECT_NEAR(cost, least_root_cost(make_leaves(triangles)), 1e-4);
}

TEST(BuildSahSweep, CostsNoMoreThanBins) {
  const std::vector<Triangle> triangles = random_soup(5000, 5);
  EXPECT_LE(measure_quality(build_sah_sweep(triangles).nodes).sah,
            measure_quality(build_sah(triangles).nodes).sah * 1.01);
}

TEST(SahBuilders, CostLessThanTheSpatialMiddle) {
  const std::vector<Triangle> triangles = random_soup(5000, 6);
  EXPECT_LT(measure_quality(build_sah(triangles).nodes).sah,
            measure_quality(build_top_down(triangles).nodes).sah);
}

}  // namespace
}  // namespace coppice
