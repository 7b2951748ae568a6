#include <gtest/gtest.h>

#include "builders/gd16.h"
#include "support/split_trees.h"

namespace coppice {
namespace {

// A triangle along a diagonal of the square at z = 0 from (x, 0) to (x + 1, 1).
Triangle diagonal(float x) { return {vec3(x, 0, 0), vec3(x + 1, 1, 0), vec3(x + 0.5f, 0.5f, 0)}; }

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

TEST(BuildGd16, TerminatedEarlyIsAValidTreeOfFewerReferences) {
  const std::vector<Triangle> triangles = needles(2000, 8);
  const ReferenceCap ample{.per_triangle = 20.0, .constant = 0};
  const Bvh bvh = build_gd16(triangles, {.reference_cap = ample, .early_termination = true});
  EXPECT_LT(bvh.references, build_gd16(triangles, {.reference_cap = ample}).references);
  expect_valid_split_tree(bvh, triangles);
  expect_no_point_lost(bvh, triangles);
}

}  // namespace
}  // namespace coppice
