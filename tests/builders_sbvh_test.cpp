#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "builders/sbvh.h"
#include "support/split_trees.h"

namespace coppice {
namespace {

TEST(BuildSbvh, SplitsNothingWhereNoOverlapIsLargeEnough) {
  const Bvh bvh = build_sbvh(needles(1000, 5), {.overlap_threshold = 1.0});
  EXPECT_EQ(bvh.references, 1000u);
  EXPECT_FALSE(bvh.reference_cap_reached);
}

TEST(BuildSbvh, RefusesAThresholdOutOfRange) {
  EXPECT_THROW(build_sbvh({}, {.overlap_threshold = -1.0}), std::invalid_argument);
  EXPECT_THROW(build_sbvh({}, {.overlap_threshold = std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
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

}  // namespace
}  // namespace coppice
