#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "analysis/quality.h"
#include "builders/gd16.h"
#include "support/split_trees.h"

namespace coppice {
namespace {

constexpr ReferenceCap NO_SPARE{.per_triangle = 1.0, .constant = 0};

// A triangle along a diagonal of the square at z = 0 from (x, 0) to (x + 1, 1).
Triangle diagonal(float x) { return {vec3(x, 0, 0), vec3(x + 1, 1, 0), vec3(x + 0.5f, 0.5f, 0)}; }

TEST(BuildGd16, GivesNoNodesForNoTriangles) {
  const Bvh bvh = build_gd16({});
  EXPECT_TRUE(bvh.nodes.empty());
  EXPECT_EQ(bvh.references, 0u);
}

TEST(BuildGd16, MakesOneTriangleTheRoot) {
  const std::vector<Triangle> triangles = {diagonal(0)};
  const Bvh bvh = build_gd16(triangles);
  ASSERT_EQ(bvh.nodes.size(), 1u);
  expect_valid_split_tree(bvh, triangles);
}

TEST(BuildGd16, LeavesInactiveTrianglesOut) {
  std::vector<Triangle> triangles = split_test_soup(50, 0.1f, 2);
  triangles[17].b.y = std::numeric_limits<float>::infinity();
  const Bvh bvh = build_gd16(triangles);
  EXPECT_EQ(bvh.active_count, 49u);
  expect_valid_split_tree(bvh, triangles);
}

// Midpoints at 0.5 and 1: the plane x = 0.75 crosses both. Whole, the sides cost 1 each (half areas of unit
// squares); clipped, 2 * 0.75^2 + 2 * 0.75^2 = 2.25.
TEST(BuildGd16, LeavesTrianglesWholeWhereThatIsCheaper) {
  const std::vector<Triangle> triangles = {diagonal(0), diagonal(0.5f)};
  const Bvh bvh = build_gd16(triangles);
  EXPECT_EQ(bvh.references, 2u);
  expect_valid_split_tree(bvh, triangles);
}

// Whole, about 1 + 1; clipped at x = 0.505, 2 * 0.5^2 + 2 * 0.5^2 = 1, near enough.
TEST(BuildGd16, SplitsTrianglesWhereThatIsCheaper) {
  const std::vector<Triangle> triangles = {diagonal(0), diagonal(0.01f)};
  const Bvh bvh = build_gd16(triangles);
  EXPECT_GT(bvh.references, 2u);
  expect_valid_split_tree(bvh, triangles);
}

TEST(BuildGd16, HalvesTrianglesWhoseMidpointsCoincide) {
  const std::vector<Triangle> triangles(1000, diagonal(0));
  const Bvh bvh = build_gd16(triangles);
  EXPECT_EQ(bvh.references, 1000u);
  EXPECT_EQ(bvh.nodes[0].height, 10u);
  expect_valid_split_tree(bvh, triangles);
}

TEST(BuildGd16, LosesNoPointOfATriangle) {
  const std::vector<Triangle> triangles = needles(2000, 3);
  const Bvh bvh = build_gd16(triangles);
  ASSERT_GT(bvh.references, 2500u);
  expect_no_point_lost(bvh, triangles);
}

TEST(BuildGd16, StaysWithinTheReferenceCap) {
  const std::vector<Triangle> triangles = needles(1000, 4);
  for (const double per_triangle : {1.0, 1.1, 1.5, 3.0}) {
    const Bvh bvh = build_gd16(triangles, {.reference_cap = {per_triangle, 7}});
    EXPECT_LE(static_cast<double>(bvh.references), 1000 * per_triangle + 7);
    expect_valid_split_tree(bvh, triangles);
  }
}

TEST(BuildGd16, ReportsThatTheCapWasReached) {
  EXPECT_TRUE(build_gd16(needles(1000, 5), {.reference_cap = NO_SPARE}).reference_cap_reached);
}

TEST(BuildGd16, ReportsNoCapThatWasNotReached) {
  const std::vector<Triangle> apart = {diagonal(0), diagonal(2), diagonal(4), diagonal(6)};
  EXPECT_FALSE(build_gd16(apart, {.reference_cap = NO_SPARE}).reference_cap_reached);
}

TEST(BuildGd16, RefusesACapBelowOneReferenceATriangle) {
  EXPECT_THROW(build_gd16({}, {.reference_cap = {0.99, 1000}}), std::invalid_argument);
  EXPECT_THROW(build_gd16({}, {.reference_cap = {std::numeric_limits<double>::quiet_NaN(), 0}}),
               std::invalid_argument);
}

TEST(BuildGd16, CutsTheCostOfNeedles) {
  const std::vector<Triangle> triangles = needles(3000, 6);
  const double whole = measure_quality(build_gd16(triangles, {.reference_cap = NO_SPARE}).nodes).sah;
  const ReferenceCap ample{.per_triangle = 5.0, .constant = 0};
  EXPECT_LT(measure_quality(build_gd16(triangles, {.reference_cap = ample}).nodes).sah, 0.6 * whole);
}

TEST(BuildGd16, GivesTheSameTreeOnAnyNumberOfThreads) {
  const std::vector<Triangle> triangles = needles(20000, 7);
  const Bvh bvh = build_gd16(triangles, {.threads = 1});
  for (const std::uint32_t threads : {2u, 3u, 8u}) {
    const Bvh other = build_gd16(triangles, {.threads = threads});
    expect_same_nodes(other, bvh);
    EXPECT_EQ(other.reference_cap_reached, bvh.reference_cap_reached);
  }
}

TEST(BuildGd16, TerminatedEarlyIsAValidTreeOfFewerReferences) {
  const std::vector<Triangle> triangles = needles(2000, 8);
  const ReferenceCap ample{.per_triangle = 20.0, .constant = 0};
  const Bvh bvh = build_gd16(triangles, {.reference_cap = ample, .early_termination = true});
  EXPECT_LT(bvh.references, build_gd16(triangles, {.reference_cap = ample}).references);
  expect_valid_split_tree(bvh, triangles);
  expect_no_point_lost(bvh, triangles);
}

class BuildGd16OfHardCase : public testing::TestWithParam<HardCase> {};

TEST_P(BuildGd16OfHardCase, IsAValidTree) {
  const std::vector<Triangle> triangles = hard_triangles(GetParam());
  for (const bool early_termination : {false, true}) {
    const Bvh bvh = build_gd16(triangles, {.early_termination = early_termination});
    expect_valid_split_tree(bvh, triangles);
    EXPECT_LE(bvh.nodes.empty() ? 0 : bvh.nodes[0].height, REFERENCE_TREE_MAX_HEIGHT);
  }
}

INSTANTIATE_TEST_SUITE_P(HardCases, BuildGd16OfHardCase,
                         testing::ValuesIn(hard_cases().begin(), hard_cases().end()),
                         [](const auto& info) { return name_of(info.param); });

class BuildGd16OfSoup : public testing::TestWithParam<std::uint32_t> {};

TEST_P(BuildGd16OfSoup, IsAValidTreeWithNoPointLost) {
  const std::vector<Triangle> triangles = split_test_soup(GetParam(), 0.5f, GetParam());
  const Bvh bvh = build_gd16(triangles);
  EXPECT_EQ(bvh.active_count, GetParam());
  expect_valid_split_tree(bvh, triangles);
  expect_no_point_lost(bvh, triangles);
}

INSTANTIATE_TEST_SUITE_P(Sizes, BuildGd16OfSoup, testing::Values(2, 3, 4, 5, 33, 1000, 5000));

}  // namespace
}  // namespace coppice
