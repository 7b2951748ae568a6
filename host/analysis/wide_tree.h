#pragma once

#include <optional>
#include <span>
#include <string>

#include "interface/types.h"
#include "interface/wide.h"

namespace coppice {

// The box of a child as its bytes say it; for an empty one box_min > box_max, or both the same.
Aabb decoded_box(const WideNode& node, uint child);

// Names the first fault of a wide tree, or none where it is that of the binary one, which is valid and splits
// no triangle:
// - no node where there is no binary one; else the root at 0, children behind their parents in depth-first
//   order, in the order of their slots, and each node reached exactly once;
// - empty children behind the others, inverted; at least two children in a node, or one where there is only
//   one leaf; WIDE_LEAST_CHILDREN where one of them is a wide node, and eight if one is that is not small;
// - each triangle of the binary tree in exactly one leaf, and no other;
// - the box of a child contains the boxes that the binary tree has for the triangles below it;
// - no more levels than the binary tree has.
// Of a refitted one, whose topology was made for other boxes, not what the areas decide; and a child may have
// the inverted box of nothing, where all triangles below it are inactive.
// Takes any array, however broken, and ends after each node has been seen once.
std::optional<std::string> find_wide_fault(std::span<const WideNode> wide_nodes, std::span<const Node> nodes,
                                           bool refitted = false);

struct WideQuality {
  std::uint64_t nodes = 0, children = 0;
  std::uint32_t levels = 0;
  double sah = 0;

  double children_per_node() const;
};

// Measures a valid wide tree; all zero for an empty one. The SAH cost is that of TreeQuality, over the boxes
// as decoded: 1 for the root, and A(child) / A(root) for every child, wide node or triangle.
WideQuality measure_wide_quality(std::span<const WideNode> wide_nodes);

}  // namespace coppice
