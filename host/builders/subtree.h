#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "builders/leaves.h"
#include "interface/types.h"

namespace coppice {

// No tree of the builders that split top-down is higher, however the scene tempts them to split off one
// triangle at a time. Traversal stacks are sized by the height, and n triangles cost O(n) time a level.
inline constexpr std::uint32_t SPLIT_HEIGHT_LIMIT = 128;

// Work left to a builder that splits a list of primitives top-down: the primitives from `begin` to `end`
// become the subtree under nodes[node]. Nodes stand in depth-first order, so the places of a subtree follow
// from the sizes of its parts alone, and parts may be built in any order, or at once.
struct Subtree {
  std::uint32_t node;
  std::uint32_t
      places;  // the nodes below `node` go to places, places + 1, ...: 2 * (end - begin) - 2 of them
  std::uint32_t begin, end;
  std::uint32_t depth;

  std::uint32_t count() const { return end - begin; }
  Subtree first_part(std::uint32_t middle) const { return {places, places + 2, begin, middle, depth + 1}; }
  Subtree second_part(std::uint32_t middle) const {
    return {places + 1, places + 2 * (middle - begin), middle, end, depth + 1};
  }
};

// All `count` primitives, at least one: the subtree under the root of a tree of 2 * count - 1 nodes.
inline Subtree whole_tree(std::uint32_t count) { return {0, 1, 0, count, 0}; }

// True when only halving the list keeps the subtree within SPLIT_HEIGHT_LIMIT.
bool must_halve(const Subtree& subtree);

// Builds the subtree. `split(subtree)` gets a subtree of at least two primitives, puts these in order and
// returns the index of the first one of the second part; `leaf_at(i)` is the leaf of primitive i once all
// splits above it are done. Writes nodes, their boxes and heights included.
template <class LeafAt, class Split>
void split_subtree(const Subtree& subtree, LeafAt&& leaf_at, std::span<Node> nodes, Split&& split);

// Box and height of an internal node from those of its children.
inline void fit_to_children(Node& node, std::span<const Node> nodes) {
  const Node& first = nodes[node.child];
  const Node& second = nodes[node.child + 1];
  const Aabb box = box_union({first.box_min, first.box_max}, {second.box_min, second.box_max});
  node.box_min = box.box_min;
  node.box_max = box.box_max;
  node.height = 1 + std::max(first.height, second.height);
}

template <class LeafAt, class Split>
void split_subtree(const Subtree& subtree, LeafAt&& leaf_at, std::span<Node> nodes, Split&& split) {
  std::vector<Subtree> stack = {subtree};
  while (!stack.empty()) {
    const Subtree top = stack.back();
    stack.pop_back();
    if (top.count() == 1) {
      nodes[top.node] = leaf_at(top.begin);
      continue;
    }
    const std::uint32_t middle = split(top);
    nodes[top.node].child = top.places;
    nodes[top.node].height = 1;  // not a leaf; the height itself comes below
    stack.push_back(top.second_part(middle));
    stack.push_back(top.first_part(middle));
  }
  // Children stand behind their parents.
  for (std::uint32_t i = subtree.places + 2 * subtree.count() - 2; i-- > subtree.places;) {
    if (nodes[i].height != 0) fit_to_children(nodes[i], nodes);
  }
  if (subtree.count() > 1) fit_to_children(nodes[subtree.node], nodes);
}

}  // namespace coppice
