#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "analysis/quality.h"
#include "builders/sbvh.h"
#include "support/split_trees.h"

namespace coppice {
namespace {

constexpr ReferenceCap NO_SPARE{.per_triangle = 1.0, .constant = 0};

TEST(BuildSbvh, GivesNoNodesForNoTriangles) {
  const Bvh bvh = build_sbvh({});
  EXPECT_TRUE(bvh.nodes.empty());
  EXPECT_EQ(bvh.references, 0u);
}

TEST(BuildSbvh, MakesOneTriangleTheRoot) {
  const std::vector<Triangle> triangles = needles(1, 1);
  const Bvh bvh = build_sbvh(triangles);
  ASSERT_EQ(bvh.nodes.size(), 1u);
  expect_valid_split_tree(bvh, triangles);
}

TEST(BuildSbvh, LeavesInactiveTrianglesOut) {
  std::vector<Triangle> triangles = split_test_soup(50, 0.1f, 2);
  triangles[17].b.y = std::numeric_limits<float>::quiet_NaN();
  const Bvh bvh = build_sbvh(triangles);
  EXPECT_EQ(bvh.active_count, 49u);
  expect_valid_split_tree(bvh, triangles);
}

TEST(BuildSbvh, LosesNoPointOfATriangle) {
  const std::vector<Triangle> triangles = needles(2000, 3);
  const Bvh bvh = build_sbvh(triangles);
  ASSERT_GT(bvh.references, 2500u);
  expect_no_point_lost(bvh, triangles);
}

TEST(BuildSbvh, StaysWithinTheReferenceCap) {
  const std::vector<Triangle> triangles = needles(1000, 4);
  for (const double per_triangle : {1.0, 1.1, 1.5, 3.0}) {
    const Bvh bvh = build_sbvh(triangles, {.reference_cap = {per_triangle, 7}});
    EXPECT_LE(static_cast<double>(bvh.references), 1000 * per_triangle + 7);
    expect_valid_split_tree(bvh, triangles);
  }
}

TEST(BuildSbvh, ReportsThatTheCapWasReached) {
  EXPECT_TRUE(build_sbvh(needles(1000, 5), {.reference_cap = NO_SPARE}).reference_cap_reached);
}

TEST(BuildSbvh, ReportsNoCapThatWasNotReached) {
  std::vector<Triangle> apart;
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<float>(2 * i);
    apart.push_back({vec3(x, 0, 0), vec3(x + 1, 0, 0), vec3(x, 1, 1)});
  }
  EXPECT_FALSE(build_sbvh(apart, {.reference_cap = NO_SPARE}).reference_cap_reached);
}

TEST(BuildSbvh, SplitsNothingWhereNoOverlapIsLargeEnough) {
  const Bvh bvh = build_sbvh(needles(1000, 5), {.overlap_threshold = 1.0});
  EXPECT_EQ(bvh.references, 1000u);
  EXPECT_FALSE(bvh.reference_cap_reached);
}

TEST(BuildSbvh, RefusesAConfigOutOfRange) {
  EXPECT_THROW(build_sbvh({}, {.reference_cap = {0.5, 1000}}), std::invalid_argument);
  EXPECT_THROW(build_sbvh({}, {.overlap_threshold = -1.0}), std::invalid_argument);
  EXPECT_THROW(build_sbvh({}, {.overlap_threshold = std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

TEST(BuildSbvh, CutsTheCostOfNeedles) {
  const std::vector<Triangle> triangles = needles(3000, 6);
  const double whole = measure_quality(build_sbvh(triangles, {.overlap_threshold = 1.0}).nodes).sah;
  const ReferenceCap ample{.per_triangle = 5.0, .constant = 0};
  EXPECT_LT(measure_quality(build_sbvh(triangles, {.reference_cap = ample}).nodes).sah, 0.6 * whole);
}

// A row of short triangles along x, each of which just reaches into the next, so that every plane across x
// crosses one or two. The last triangle is a long one askew from one end of the row to the other.
std::vector<Triangle> row_under_a_long_triangle() {
  std::vector<Triangle> triangles;
  for (int i = 0; i < 32; ++i) {
    const vec3 corner(-8 + 0.5f * static_cast<float>(i), -1, -1);
    triangles.push_back({corner, corner + vec3(0.51f, 2, 0), corner + vec3(0, 2, 2)});
  }
  triangles.push_back({vec3(-8, -1, -1), vec3(8, 1, 1), vec3(8, 1, 0.9f)});
  return triangles;
}

TEST(BuildSbvh, LeavesATriangleWholeWhereThatIsCheaperThanToSplitIt) {
  const std::vector<Triangle> triangles = row_under_a_long_triangle();
  const Bvh bvh = build_sbvh(triangles, {.overlap_threshold = 0.2});
  std::vector<int> leaves(triangles.size());
  for (const Node& node : bvh.nodes) {
    if (node.height == 0) ++leaves[node.child];
  }
  EXPECT_GT(leaves[32], 1);
  for (int i = 0; i < 32; ++i) EXPECT_EQ(leaves[i], 1) << "triangle " << i;
  expect_no_point_lost(bvh, triangles);
}

TEST(BuildSbvh, GivesTheSameTreeOnAnyNumberOfThreads) {
  const std::vector<Triangle> triangles = needles(20000, 7);
  const Bvh bvh = build_sbvh(triangles, {.threads = 1});
  expect_valid_split_tree(bvh, triangles);
  for (const std::uint32_t threads : {2u, 3u, 8u}) {
    const Bvh other = build_sbvh(triangles, {.threads = threads});
    expect_same_nodes(other, bvh);
    EXPECT_EQ(other.reference_cap_reached, bvh.reference_cap_reached);
  }
}

class BuildSbvhOfHardCase : public testing::TestWithParam<HardCase> {};

TEST_P(BuildSbvhOfHardCase, IsAValidTree) {
  const std::vector<Triangle> triangles = hard_triangles(GetParam());
  const Bvh bvh = build_sbvh(triangles);
  expect_valid_split_tree(bvh, triangles);
  EXPECT_LE(bvh.nodes.empty() ? 0 : bvh.nodes[0].height, REFERENCE_TREE_MAX_HEIGHT);
}

INSTANTIATE_TEST_SUITE_P(HardCases, BuildSbvhOfHardCase,
                         testing::ValuesIn(hard_cases().begin(), hard_cases().end()),
                         [](const auto& info) { return name_of(info.param); });

class BuildSbvhOfSoup : public testing::TestWithParam<std::uint32_t> {};

TEST_P(BuildSbvhOfSoup, IsAValidTreeWithNoPointLost) {
  const std::vector<Triangle> triangles = split_test_soup(GetParam(), 0.5f, GetParam());
  const Bvh bvh = build_sbvh(triangles);
  EXPECT_EQ(bvh.active_count, GetParam());
  expect_valid_split_tree(bvh, triangles);
  expect_no_point_lost(bvh, triangles);
}

INSTANTIATE_TEST_SUITE_P(Sizes, BuildSbvhOfSoup, testing::Values(2, 3, 4, 5, 33, 1000, 5000));

}  // namespace
}  // namespace coppice
