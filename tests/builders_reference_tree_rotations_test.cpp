#include <gtest/gtest.h>

#include "analysis/quality.h"
#include "builders/reference_tree_rotations.h"
#include "builders/top_down.h"
#include "support/split_trees.h"

namespace coppice {
namespace {

std::vector<Node> rotated(std::vector<Node> nodes, std::uint32_t height_limit) {
  std::vector<Node> result(nodes.size());
  rotate_tree(nodes, result, 1.0f, height_limit);
  return result;
}

std::vector<Triangle> soup() { return split_test_soup(2000, 0.5f, 1); }

TEST(RotateTree, KeepsATreeValid) {
  const std::vector<Triangle> triangles = soup();
  const std::vector<Node> nodes = rotated(build_top_down(triangles).nodes, 200);
  EXPECT_EQ(find_fault(nodes, triangles, {}).value_or("no fault"), "no fault");
}

TEST(RotateTree, CutsTheCostInEveryPass) {
  std::vector<Node> nodes = build_top_down(soup()).nodes;
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<Node> next = rotated(nodes, 200);
    EXPECT_LT(measure_quality(next).sah, measure_quality(nodes).sah);
    nodes = std::move(next);
  }
}

TEST(RotateTree, LeavesALeafAlone) {
  const Node leaf = {vec3(0), 7, vec3(1), 0};
  EXPECT_EQ(rotated({leaf}, 0)[0].child, 7u);
}

TEST(RotateTree, StaysWithinTheHeightLimit) {
  const std::vector<Node> nodes = build_top_down(soup()).nodes;
  const std::uint32_t height = nodes[0].height;
  // Without a limit that matters the tree grows higher, else the next line shows nothing.
  ASSERT_GT(rotated(nodes, 200)[0].height, height);
  EXPECT_LE(rotated(nodes, height)[0].height, height);
}

TEST(RotateTree, SwapsAChildWithANephewWhereThatIsCheaper) {
  // The root holds (a, b) and c, but b and c are neighbours.
  const auto at = [](float x, std::uint32_t triangle) {
    return Node{vec3(x, 0, 0), triangle, vec3(x + 1, 1, 1), 0};
  };
  const std::vector<Node> nodes = {
      {vec3(0), 1, vec3(10, 1, 1), 2}, {vec3(0), 3, vec3(9, 1, 1), 1}, at(9, 2), at(0, 0), at(8, 1)};
  const std::vector<Node> result = rotated(nodes, 2);
  const Node& pair = result[1].height > 0 ? result[1] : result[2];
  EXPECT_EQ(pair.box_min.x, 8.0f);
  EXPECT_EQ(pair.box_max.x, 10.0f);
}

}  // namespace
}  // namespace coppice
