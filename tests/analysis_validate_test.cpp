#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/validate.h"
#include "builders/ploc.h"
#include "interface/refit.h"
#include "scene/random.h"
#include "support/floor.h"

namespace coppice {
namespace {

// A valid tree, for each test to break.
class FindFault : public testing::Test {
 protected:
  FindFault() {
    Random random(7);
    for (int i = 0; i < 20; ++i) {
      const vec3 a = random.in_cube();
      const vec3 b = random.in_cube();
      const vec3 c = random.in_cube();
      triangles_.push_back({a, b, c});
    }
    nodes_ = build_ploc(triangles_).nodes;
  }

  std::string fault(const TreePromises& promises = {}) const {
    return find_fault(nodes_, triangles_, promises).value_or("none");
  }

  void expect_fault(const std::string& part, const TreePromises& promises = {}) const {
    EXPECT_NE(fault(promises).find(part), std::string::npos) << fault(promises);
  }

  // Some node, neither root nor child of the root, of the kind asked for.
  std::size_t some_leaf() const { return some_node(true); }
  std::size_t some_internal() const { return some_node(false); }

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;

 private:
  std::size_t some_node(bool leaf) const {
    for (std::size_t i = 3; i < nodes_.size(); ++i) {
      if ((nodes_[i].height == 0) == leaf) return i;
    }
    throw std::logic_error("no such node");
  }
};

TEST_F(FindFault, AcceptsAValidTree) { EXPECT_EQ(fault(), "none"); }

TEST_F(FindFault, AcceptsNoNodesForNoTriangles) { EXPECT_FALSE(find_fault({}, {})); }

// Behind a refit an inactive triangle keeps its leaf, with the box of nothing and no other; an active one has
// none such.
TEST_F(FindFault, BoxesOfNothingInARefittedTreeOnly) {
  std::vector<Node> built = nodes_;
  const std::vector<Triangle> triangles = triangles_;
  const auto set_nothing = [](Node& node) {
    node.box_min = vec3(NOTHING_BOX);
    node.box_max = vec3(-NOTHING_BOX);
  };
  for (Node& node : nodes_) set_nothing(node);
  for (Triangle& triangle : triangles_) triangle.b.y = std::nanf("");
  EXPECT_EQ(fault({.refitted = true}), "none");
  expect_fault("box_min > box_max");
  nodes_[some_leaf()].box_max.x = 0;
  expect_fault("does not contain that of its child", {.refitted = true});
  set_nothing(nodes_[some_leaf()]);
  triangles_[nodes_[some_leaf()].child] = triangles[nodes_[some_leaf()].child];
  expect_fault("no box for", {.refitted = true});
  nodes_ = built;
  triangles_ = triangles;
  EXPECT_EQ(fault({.refitted = true}), "none");
  triangles_[nodes_[some_leaf()].child].a.z = std::nanf("");
  expect_fault("has a box for inactive", {.refitted = true});
  expect_fault("holds inactive");
}

TEST_F(FindFault, AcceptsNoNodesForInactiveTriangles) {
  const std::vector<Triangle> inactive = {{vec3(0), vec3(NOT_A_NUMBER), vec3(1)},
                                          {vec3(0), vec3(INFINITE), vec3(1)}};
  EXPECT_FALSE(find_fault({}, inactive));
}

TEST_F(FindFault, RejectsNoNodesForActiveTriangles) {
  nodes_.clear();
  expect_fault("triangle 0 is in no leaf");
}

TEST_F(FindFault, RejectsNodesForNoTriangles) {
  triangles_.clear();
  EXPECT_NE(fault(), "none");
}

TEST_F(FindFault, RejectsAChildOfTwoParents) {
  nodes_[0].child = nodes_[some_internal()].child;
  EXPECT_NE(fault(), "none");
}

TEST_F(FindFault, NamesAChildOfTwoParents) {
  triangles_.assign(4, triangles_[0]);
  nodes_ = build_ploc(triangles_).nodes;
  ASSERT_EQ(nodes_[1].height, 1u);
  ASSERT_EQ(nodes_[2].height, 1u);
  nodes_[2].child = nodes_[1].child;
  expect_fault("is reached twice");
}

TEST_F(FindFault, RejectsACycle) {
  nodes_[some_internal()].child = 1;
  expect_fault("is reached twice");
}

TEST_F(FindFault, RejectsAMissingLeaf) {
  triangles_.push_back(triangles_[3]);
  expect_fault("triangle 20 is in no leaf");
}

TEST_F(FindFault, RejectsATriangleInTwoLeaves) {
  triangles_.assign(2, triangles_[0]);
  nodes_ = build_ploc(triangles_).nodes;
  nodes_[2].child = nodes_[1].child;
  expect_fault("is in more than one leaf");
}

TEST_F(FindFault, RejectsUnreachedNodes) {
  nodes_.push_back(nodes_[1]);
  nodes_.push_back(nodes_[2]);
  expect_fault("node 39 is not reached");
}

TEST_F(FindFault, RejectsAnInternalBoxTooSmallByOneUlp) {
  const std::size_t i = some_internal();
  nodes_[i].box_max.y = std::nextafter(nodes_[i].box_max.y, -INFINITE);
  expect_fault("node " + std::to_string(i) + " has a box that does not contain that of its child",
               {.tight_boxes = false});
}

TEST_F(FindFault, RejectsALeafBoxTooSmallByOneUlp) {
  const std::size_t i = some_leaf();
  nodes_[i].box_min.z = std::nextafter(nodes_[i].box_min.z, INFINITE);
  expect_fault("node " + std::to_string(i) + " has a box that does not contain triangle",
               {.tight_boxes = false});
}

TEST_F(FindFault, RejectsABoxTooLargeByOneUlpWhereBoxesAreTight) {
  nodes_[0].box_max.x = std::nextafter(nodes_[0].box_max.x, INFINITE);
  expect_fault("node 0 has a box larger than the union");
  EXPECT_EQ(fault({.tight_boxes = false}), "none");
}

TEST_F(FindFault, RejectsNaNInAnyCoordinateOfABox) {
  const std::vector<Node> valid = nodes_;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      nodes_ = valid;
      nodes_[i].box_min[axis] = NOT_A_NUMBER;
      EXPECT_NE(fault({.tight_boxes = false}), "none");
      nodes_ = valid;
      nodes_[i].box_max[axis] = NOT_A_NUMBER;
      EXPECT_NE(fault({.tight_boxes = false}), "none");
    }
  }
}

TEST_F(FindFault, RejectsAWrongHeight) {
  ++nodes_[0].height;
  expect_fault("node 0 has height");
}

TEST_F(FindFault, RejectsAChildIndexOutOfRange) {
  for (const std::uint32_t child : {38u, 39u, 0xfffffffeu, 0xffffffffu}) {
    nodes_[0].child = child;
    expect_fault("node 0 has a child index out of range");
  }
}

TEST_F(FindFault, RejectsATriangleIndexOutOfRange) {
  nodes_[some_leaf()].child = 20;
  expect_fault("holds triangle 20 of 20");
}

TEST_F(FindFault, RejectsAnInactiveTriangleInALeaf) {
  triangles_[5].b.x = NOT_A_NUMBER;
  expect_fault("holds inactive triangle 5");
}

TEST_F(FindFault, RejectsEveryFlippedBit) {
  for (Node& node : nodes_) {
    const Node valid = node;
    for (int bit = 0; bit < 256; ++bit) {
      auto words = std::bit_cast<std::array<std::uint32_t, 8>>(valid);
      words[bit / 32] ^= 1u << (bit % 32);
      node = std::bit_cast<Node>(words);
      EXPECT_NE(fault(), "none") << "bit " << bit << " of node " << &node - nodes_.data();
    }
    node = valid;
  }
}

TEST_F(FindFault, AcceptsTwoLeavesThatCoverASplitTriangleOnlyWhereSplitsArePromised) {
  triangles_ = {{vec3(0, 0, 0), vec3(2, 0, 0), vec3(2, 1, 0)}};
  nodes_ = {{vec3(0), 1, vec3(2, 1, 0), 1},
            {vec3(0), 0, vec3(1, 0.5f, 0), 0},
            {vec3(1, 0, 0), 0, vec3(2, 1, 0), 0}};
  EXPECT_EQ(fault({.splits_triangles = true}), "none");
  EXPECT_NE(fault(), "none");
}

TEST_F(FindFault, RejectsASplitTriangleWithACornerInNoLeaf) {
  triangles_ = {{vec3(0, 0, 0), vec3(2, 0, 0), vec3(2, 1, 0)}};
  nodes_ = {{vec3(0), 1, vec3(2, 1, 0), 1},
            {vec3(0), 0, vec3(1, 0.5f, 0), 0},
            {vec3(1, 0.5f, 0), 0, vec3(2, 1, 0), 0}};
  EXPECT_EQ(fault({.splits_triangles = true}), "triangle 0 has a corner outside of the boxes of its leaves");
}

TEST_F(FindFault, AcceptsAChainOfAMillionNodes) {
  constexpr std::uint32_t LEAVES = 500000;
  triangles_.assign(LEAVES, Triangle{vec3(0), vec3(1), vec3(0.5f)});
  nodes_ = {{vec3(0), 1, vec3(1), LEAVES - 1}};
  for (std::uint32_t i = 1; i < LEAVES; ++i) {
    nodes_.push_back({vec3(0), i - 1, vec3(1), 0});
    nodes_.push_back({vec3(0), i + 1 < LEAVES ? 2 * i + 1 : LEAVES - 1, vec3(1), LEAVES - 1 - i});
  }
  EXPECT_EQ(fault(), "none");
}

}  // namespace
}  // namespace coppice
