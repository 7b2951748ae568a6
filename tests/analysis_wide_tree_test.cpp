// Wide trees as the twins make them: valid, the same as a plain recursive collapse makes, their boxes as
// small as their grids allow; and the validator finds what is spoilt.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "analysis/wide_tree.h"
#include "builders/hploc.h"
#include "builders/lbvh.h"
#include "builders/ploc.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "support/triangles.h"
#include "support/wide.h"

namespace coppice {
namespace {

// --- A collapse in the words of the paper, without levels, scans or normalised boxes.

float half_area(const Node& node) {
  const vec3 extent = node.box_max - node.box_min;
  return extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0];
}

// Negative for a small part of `whole` that is higher than two.
float weighted_area(const Node& node, const Node& whole) {
  if (node.height <= 2) return half_area(node) * (node.height == 1 ? 16.0f : 4.0f);
  return half_area(node) < half_area(whole) / 1024 ? -1.0f : half_area(node);
}

struct PlainNode {
  uint root;
  std::vector<uint> children;  // binary nodes
  std::vector<uint> words;
};

uint collapse(std::span<const Node> nodes, uint root, std::vector<PlainNode>& wide) {
  const uint place = static_cast<uint>(wide.size());
  wide.push_back({root, {root}, {}});
  std::vector<uint> children = {root};
  while (children.size() < WIDE_CHILDREN) {
    int best = -1;
    for (int c = 0; c < static_cast<int>(children.size()); ++c) {
      if (nodes[children[c]].height == 0) continue;
      const auto area = [&](uint child) { return weighted_area(nodes[child], nodes[root]); };
      if (best < 0 || area(children[c]) > area(children[best])) best = c;
    }
    if (best < 0) break;
    if (children.size() >= 3 && weighted_area(nodes[children[best]], nodes[root]) < 0) break;
    const uint pair = nodes[children[best]].child;
    children[best] = pair;
    children.push_back(pair + 1);
  }
  std::vector<uint> words;
  for (const uint child : children) {
    words.push_back(nodes[child].height == 0 ? WIDE_LEAF | nodes[child].child : collapse(nodes, child, wide));
  }
  wide[place].children = children;
  wide[place].words = words;
  return place;
}

void expect_tightest_box(const WideNode& node, uint c, const Node& child) {
  const Aabb box = decoded_box(node, c);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.box_min[axis], child.box_min[axis]);
    EXPECT_GE(box.box_max[axis], child.box_max[axis]);
    for (const int side : {0, 3}) {
      const uint byte = 6 * c + side + axis;
      WideNode smaller = node;
      const uint q = node.planes[byte / 4] >> byte % 4 * 8 & 255;
      if (q == (side == 0 ? 255u : 0u)) continue;
      smaller.planes[byte / 4] += (side == 0 ? 1u : -1u) << byte % 4 * 8;
      const Aabb cut = decoded_box(smaller, c);
      EXPECT_TRUE(cut.box_min[axis] > child.box_min[axis] || cut.box_max[axis] < child.box_max[axis])
          << "axis " << axis << ", plane " << q;
    }
  }
}

void expect_as_plainly_collapsed(std::span<const Node> nodes, const std::string& what) {
  const std::vector<WideNode> wide = widen_by_twins(nodes);
  EXPECT_EQ(find_wide_fault(wide, nodes), std::nullopt) << what;
  std::vector<PlainNode> plain;
  if (!nodes.empty()) collapse(nodes, 0, plain);
  ASSERT_EQ(wide.size(), plain.size()) << what;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    EXPECT_EQ(wide[i].origin, nodes[plain[i].root].box_min) << what;
    for (uint c = 0; c < WIDE_CHILDREN; ++c) {
      const bool there = c < plain[i].words.size();
      ASSERT_EQ(wide[i].child[c], there ? plain[i].words[c] : WIDE_EMPTY) << what << ", node " << i;
      if (there) expect_tightest_box(wide[i], c, nodes[plain[i].children[c]]);
    }
    if (testing::Test::HasFailure()) FAIL() << what << ", node " << i;
  }
}

TEST(WideTreeOfTwins, IsThatOfAPlainCollapse) {
  for (const uint count : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 15u, 16u, 17u, 64u, 300u, 5000u}) {
    const auto triangles = random_soup(count, count + 1);
    expect_as_plainly_collapsed(build_ploc(triangles, {.radius = 4}).nodes, std::to_string(count));
    expect_as_plainly_collapsed(build_hploc(triangles, {}).nodes, std::to_string(count));
    expect_as_plainly_collapsed(build_lbvh(triangles, {}).nodes, std::to_string(count));
  }
}

TEST(WideTreeOfTwins, IsThatOfAPlainCollapseWhereChildrenAreSmall) {
  for (const char* name : {"detail-on-ground", "detail-in-dome", "stray-corner", "detail-in-detail"}) {
    for (const uint count : {9u, 20u, 300u, 3000u}) {
      const auto triangles = scene_arrays(find_hard_case(name)->make(count, 1)).triangles;
      expect_as_plainly_collapsed(build_ploc(triangles, {.radius = 8}).nodes, name + std::to_string(count));
    }
  }
}

TEST(WideTreeOfTwins, HardCasesAreValidAndTight) {
  for (const HardCase& hard_case : hard_cases()) {
    const auto triangles =
        scene_arrays(hard_case.make(std::min(hard_case.default_triangle_count, 3000u), 1)).triangles;
    const Bvh bvh = build_ploc(triangles, {.radius = 8});
    EXPECT_EQ(find_wide_fault(widen_by_twins(bvh.nodes), bvh.nodes), std::nullopt) << hard_case.name;
  }
}

// A perfect tree of 2 * 8^k leaves has the most wide nodes without small children if those at the bottom have
// two leaves each. So it is where pairs of leaves coincide in points: their nodes have no area and are opened
// last.
std::vector<Node> perfect_tree(uint leaves) {
  std::vector<Node> nodes(2 * leaves - 1);
  for (uint i = static_cast<uint>(nodes.size()); i-- > 0;) {
    const uint depth = std::bit_width(i + 1) - 1, row = i + 1 - (1u << depth);
    const float width = static_cast<float>(leaves >> depth);
    const bool leaf = 2 * i + 1 >= nodes.size();
    const vec3 low(static_cast<float>(leaf ? row / 2 * 2 : row) * width, 0, 0),
        high = low + vec3(width, 1, 1);
    const uint height = leaf ? 0 : nodes[2 * i + 1].height + 1;
    nodes[i] = {low, leaf ? row : 2 * i + 1, height < 2 ? low : high, height};
  }
  return nodes;
}

TEST(WideTreeOfTwins, PerfectTreesHaveFourWideNodesOfSevenLeaves) {
  const uint leaves = 2 * 8 * 8 * 8;
  const std::vector<Node> nodes = perfect_tree(leaves);
  const std::vector<WideNode> wide = widen_by_twins(nodes);
  EXPECT_EQ(find_wide_fault(wide, nodes), std::nullopt);
  EXPECT_EQ(wide.size(), (4 * leaves - 1) / 7);
  EXPECT_LE(wide.size(), wide_nodes_bound(leaves));
}

// Three trees under a root whose children they are.
std::vector<Node> three_trees(const std::vector<Node>& tree, float distance) {
  std::vector<Node> nodes(5);
  for (uint k = 0; k < 3; ++k) {
    const uint place = k == 0 ? 1 : 2 + k, first = static_cast<uint>(nodes.size());
    const auto moved = [&](Node node) {
      const vec3 by(0, static_cast<float>(k) * distance, static_cast<float>(k % 2) * distance);
      node.box_min += by;
      node.box_max += by;
      node.child += node.height == 0 ? k * static_cast<uint>(tree.size() + 1) / 2 : first - 1;
      return node;
    };
    nodes[place] = moved(tree[0]);
    for (const Node& node : std::span(tree).subspan(1)) nodes.push_back(moved(node));
  }
  for (const uint parent : {2u, 0u}) {
    const Node &left = nodes[parent + 1], &right = nodes[parent + 2];
    nodes[parent] = {glm::min(left.box_min, right.box_min), parent + 1, glm::max(left.box_max, right.box_max),
                     std::max(left.height, right.height) + 1};
  }
  return nodes;
}

// As many as there may be: nodes of three small children, above nodes of eight, above pairs of leaves.
TEST(WideTreeOfTwins, MeetsItsBoundWhereChildrenAreSmall) {
  std::vector<Node> nodes = perfect_tree(16);
  for (const float distance : {1e5f, 8e6f}) {
    nodes = three_trees(nodes, distance);
    const uint leaves = static_cast<uint>(nodes.size() + 1) / 2;
    const std::vector<WideNode> wide = widen_by_twins(nodes);
    EXPECT_EQ(find_wide_fault(wide, nodes), std::nullopt);
    EXPECT_EQ(wide.size(), (19 * leaves - 16) / 32);
    EXPECT_LE(wide.size(), wide_nodes_bound(leaves));
  }
}

TEST(WideTreeOfTwins, ChainsUpToTheHeightThatIsTaken) {
  for (const uint height : {1u, 2u, 6u, 7u, 8u, 255u, WIDE_MAX_HEIGHT}) {
    const std::vector<Node> nodes = chain_of_leaves(height + 1);
    uint error_word = 1;
    const std::vector<WideNode> wide = widen_by_twins(nodes, &error_word);
    EXPECT_EQ(error_word, 0u);
    EXPECT_EQ(find_wide_fault(wide, nodes), std::nullopt) << height;
  }
  uint error_word = 0;
  EXPECT_TRUE(widen_by_twins(chain_of_leaves(WIDE_MAX_HEIGHT + 2), &error_word).empty());
  EXPECT_EQ(error_word, ERROR_WIDE_TOO_DEEP);
}

// --- Boxes where rounding is at its worst.

Node leaf_box(float low, float high, uint triangle) { return {vec3(low), triangle, vec3(high), 0}; }

void expect_pair_is_held(float low, float middle, float high) {
  const std::vector<Node> nodes = {
      {vec3(low), 1, vec3(high), 1}, leaf_box(low, middle, 0), leaf_box(middle, high, 1)};
  const std::vector<WideNode> wide = widen_by_twins(nodes);
  const std::string what = std::to_string(low) + ", " + std::to_string(middle) + ", " + std::to_string(high);
  EXPECT_EQ(find_wide_fault(wide, nodes), std::nullopt) << what;
  ASSERT_EQ(wide.size(), 1u) << what;
  for (uint c = 0; c < 2; ++c) expect_tightest_box(wide[0], c, nodes[1 + c]);
}

TEST(WideBoxes, HoldNeighbouringFloatsFlatBoxesAndTheEndsOfTheRange) {
  const float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::min();
  for (const float x : {0.0f, least, 1e-30f, 1.0f, 3.0f, 16777216.0f, 1e8f, 1e30f, most / 2}) {
    for (const float low : {x, -x}) {
      const float next = std::nextafter(low, most), after = std::nextafter(next, most);
      expect_pair_is_held(low, low, low);
      if (low != 0 && std::fabs(low) > 2 * least) expect_pair_is_held(low, next, after);
      expect_pair_is_held(low, low, most);
      expect_pair_is_held(-most, low, low);
    }
  }
  expect_pair_is_held(-most, 0, most);
  expect_pair_is_held(-most, most / 2, most);
  expect_pair_is_held(-least, 0, least);
}

TEST(WideBoxes, HoldRandomOnesOfAllScales) {
  std::uint32_t state = 1;
  const auto next = [&] {
    state = state * 1664525u + 1013904223u;
    const float x = std::bit_cast<float>((state >> 1 & 0x7fffffffu) | (state << 31));
    return std::isnormal(x) ? x : 0.0f;
  };
  for (int i = 0; i < 2000; ++i) {
    float x[3] = {next(), next(), next()};
    if (i % 2) {  // close to each other
      x[1] = x[0] * (1 + static_cast<float>(i) * 0x1p-24f);
      x[2] = x[0] * (1 + static_cast<float>(state >> 20) * 0x1p-20f);
    }
    if (!std::isfinite(x[1]) || !std::isfinite(x[2])) continue;
    std::ranges::sort(x);
    expect_pair_is_held(x[0], x[1], x[2]);
    if (HasFailure()) FAIL() << "in round " << i;
  }
}

// --- Planted faults.

struct SpoiltTree {
  const char* fault;  // part of what the validator says
  std::function<void(std::vector<WideNode>&)> spoil;
};

// The first child that is a triangle, or a wide node, in the first node with one behind the root.
uint* find_child(std::vector<WideNode>& wide, bool wide_child, std::size_t from = 1) {
  for (std::size_t i = from; i < wide.size(); ++i) {
    for (uint& child : wide[i].child) {
      if (child != WIDE_EMPTY && ((child & WIDE_LEAF) == 0) == wide_child) return &child;
    }
  }
  return nullptr;
}

std::vector<SpoiltTree> spoilt_trees() {
  return {
      {"is not there", [](auto& wide) { wide.pop_back(); }},
      {"is not reached", [](auto& wide) { wide.push_back(wide.back()); }},
      {"next in depth-first order", [](auto& wide) { ++*find_child(wide, true); }},
      {"more than one leaf",
       [](auto& wide) { *find_child(wide, false) = *find_child(wide, false, wide.size() / 2); }},
      {"which the binary tree has not", [](auto& wide) { *find_child(wide, false) = WIDE_LEAF | 5000; }},
      {"does not contain", [](auto& wide) { wide.front().planes[0] += 1; }},
      {"does not contain", [](auto& wide) { wide.back().exponents -= 0x010101; }},
      {"does not contain", [](auto& wide) { wide[7].origin.y += 0.1f; }},
      {"behind an empty one",
       [](auto& wide) {
         std::ranges::find(wide, WIDE_EMPTY, [](const WideNode& n) { return n.child[6]; })->child[7] = 3;
       }},
      {"is empty and has a box",
       [](auto& wide) {
         auto node = std::ranges::find(wide, WIDE_EMPTY, [](const WideNode& n) { return n.child[7]; });
         node->planes[11] ^= 1u << 24;
       }},
  };
}

TEST(WideValidation, FindsPlantedFaults) {
  const auto triangles = random_soup(2000, 5);
  const Bvh bvh = build_ploc(triangles, {.radius = 8});
  const std::vector<WideNode> wide = widen_by_twins(bvh.nodes);
  ASSERT_EQ(find_wide_fault(wide, bvh.nodes), std::nullopt);
  for (const SpoiltTree& spoilt : spoilt_trees()) {
    std::vector<WideNode> copy = wide;
    spoilt.spoil(copy);
    const auto fault = find_wide_fault(copy, bvh.nodes);
    ASSERT_TRUE(fault) << spoilt.fault;
    EXPECT_NE(fault->find(spoilt.fault), std::string::npos) << *fault << " instead of " << spoilt.fault;
  }
}

TEST(WideQualityOf, ATreeWorkedOutByHand) {
  // Two unit cubes, one at each end of a bar of length 255, so that the planes are exact.
  const std::vector<Node> nodes = {
      {vec3(0), 1, vec3(255, 1, 1), 1}, {vec3(0), 0, vec3(1), 0}, {vec3(254, 0, 0), 1, vec3(255, 1, 1), 0}};
  const WideQuality quality = measure_wide_quality(widen_by_twins(nodes));
  EXPECT_EQ(quality.nodes, 1u);
  EXPECT_EQ(quality.children, 2u);
  EXPECT_EQ(quality.levels, 1u);
  // Steps of 1 along x and 2^-7 along y and z: the decoded boxes are the boxes.
  EXPECT_DOUBLE_EQ(quality.sah, 1 + 2 * 3.0 / 511);
  EXPECT_EQ(measure_wide_quality({}).nodes, 0u);
}

}  // namespace
}  // namespace coppice
