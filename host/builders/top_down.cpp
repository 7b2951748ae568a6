#include "builders/top_down.h"

#include <algorithm>
#include <vector>

#include "builders/leaves.h"
#include "builders/subtree.h"

namespace coppice {
namespace {

// Half the length: that of a box across the whole range of float would be infinite.
vec3 half_extent(const Aabb& box) { return box.box_max * 0.5f - box.box_min * 0.5f; }

int longest_axis(const Aabb& box) {
  const vec3 extent = half_extent(box);
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (extent[axis] > extent[longest]) longest = axis;
  }
  return longest;
}

// Halves first, so that no sum overflows.
float centre(float low, float high) { return low * 0.5f + high * 0.5f; }

// Puts the leaves below the plane before the others and returns the index of the first one of the others.
std::uint32_t split_at_middle(const Subtree& subtree, std::span<Node> leaves) {
  const std::uint32_t list_middle = subtree.begin + subtree.count() / 2;
  if (must_halve(subtree)) return list_middle;
  const std::span<Node> run = leaves.subspan(subtree.begin, subtree.count());
  const Aabb box = bounds_of(run);
  const int axis = longest_axis(box);
  const float plane = centre(box.box_min[axis], box.box_max[axis]);
  const auto first_above = std::partition(run.begin(), run.end(), [=](const Node& leaf) {
    return centre(leaf.box_min[axis], leaf.box_max[axis]) < plane;
  });
  if (first_above == run.begin() || first_above == run.end()) return list_middle;
  return subtree.begin + static_cast<std::uint32_t>(first_above - run.begin());
}

}  // namespace

Bvh build_top_down(std::span<const Triangle> triangles) {
  std::vector<Node> leaves = make_leaves(triangles);
  Bvh bvh;
  bvh.active_count = static_cast<std::uint32_t>(leaves.size());
  if (leaves.empty()) return bvh;
  bvh.nodes.resize(2 * leaves.size() - 1);
  split_subtree(
      whole_tree(bvh.active_count), [&](std::uint32_t i) { return leaves[i]; }, bvh.nodes,
      [&](const Subtree& subtree) { return split_at_middle(subtree, leaves); });
  return bvh;
}

}  // namespace coppice
