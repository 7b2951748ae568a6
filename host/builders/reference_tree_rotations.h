#pragma once

#include <cstdint>
#include <span>

#include "interface/types.h"

namespace coppice {

// One pass of tree rotations: Kensler, "Tree Rotations for Improving Bounding Volume Hierarchies", IEEE
// Symposium on Interactive Ray Tracing 2008. From the leaves up, each node looks at its grandchildren: a
// child may change places with a child of its sibling, or two grandchildren that are cousins with each other,
// whatever reduces the sum of the areas of its children most. The leaves stay what they are.
//
// `nodes` is a tree of at least one node, root at 0, siblings adjacent, each node before its children; so it
// is in `rotated`, which has room for as many nodes and is in depth-first order. `scale` is that of
// lane_box.h, `height_limit` the greatest height that the tree may have: at least what it has, at most 255.
void rotate_tree(std::span<Node> nodes, std::span<Node> rotated, float scale, std::uint32_t height_limit);

}  // namespace coppice
