#pragma once

#include <glm/common.hpp>
#include <span>
#include <vector>

#include "interface/types.h"

namespace coppice {

class Threads;

// True when every coordinate of every corner is finite. Other triangles are inactive: no tree holds them.
bool is_active(const Triangle& triangle);

// The smallest box around the three corners of an active triangle.
Aabb triangle_box(const Triangle& triangle);

// One leaf for each active triangle, by ascending triangle index: the primitives a builder starts from.
// At most 2^31 triangles, so that node indices fit into 32 bits; throws std::length_error beyond.
std::vector<Node> make_leaves(std::span<const Triangle> triangles);
std::vector<Node> make_leaves(std::span<const Triangle> triangles, const Threads& threads);

// The box of both boxes.
inline Aabb box_union(const Aabb& a, const Aabb& b) {
  return {glm::min(a.box_min, b.box_min), glm::max(a.box_max, b.box_max)};
}

// The box of all nodes' boxes; box_min = +infinity, box_max = -infinity when there is none.
Aabb bounds_of(std::span<const Node> nodes);
Aabb bounds_of(std::span<const Node> nodes, const Threads& threads);

}  // namespace coppice
