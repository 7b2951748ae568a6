#pragma once

#include <span>
#include <vector>

#include "interface/types.h"

namespace coppice {

// True when every coordinate of every corner is finite. Other triangles are inactive: no tree holds them.
bool is_active(const Triangle& triangle);

// The smallest box around the three corners of an active triangle.
Aabb triangle_box(const Triangle& triangle);

// One leaf for each active triangle, by ascending triangle index: the primitives a builder starts from.
// At most 2^31 triangles, so that node indices fit into 32 bits; throws std::length_error beyond.
std::vector<Node> make_leaves(std::span<const Triangle> triangles);

// The box of both boxes.
Aabb box_union(const Aabb& a, const Aabb& b);

// The box of all nodes' boxes; box_min = +infinity, box_max = -infinity when there is none.
Aabb bounds_of(std::span<const Node> nodes);

}  // namespace coppice
