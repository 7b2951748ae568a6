#include <algorithm>

#include "twins/tree_area.h"

namespace coppice::twins {

namespace {

bool is_nothing(const Node& node) { return node.box_min.x > node.box_max.x; }

}  // namespace

TreeArea::TreeArea(const Node& root)
    : normalise_(is_nothing(root) ? Aabb{vec3(0), vec3(0)} : Aabb{root.box_min, root.box_max}) {}

float TreeArea::operator()(const Node& node) const {
  if (is_nothing(node)) return 0;
  const Aabb box{normalise_(node.box_min), normalise_(node.box_max)};
  return union_area(box, box) * TREE_AREAS_SCALE;
}

float group_sum(std::array<float, TREE_AREAS_GROUP> parts) {
  for (std::size_t count = parts.size(); count > 1; count /= 2) {
    for (std::size_t i = 0; i < count / 2; ++i) parts[i] += parts[count / 2 + i];
  }
  return parts[0];
}

void tree_areas(const TreeAreasArgs& args) {
  const uint leaves = args.state[0].active_count;
  const uint count = leaves == 0 ? 0 : 2 * leaves - 1;
  if (count == 0) return;
  const TreeArea area(args.nodes[0]);
  for (uint first = 0, tile = 0; first < count; first += TREE_AREAS_TILE, ++tile) {
    std::array<float, TREE_AREAS_GROUP> parts{};
    for (uint i = first; i < std::min(first + TREE_AREAS_TILE, count); ++i)
      parts[i % TREE_AREAS_GROUP] += area(args.nodes[i]);
    args.tile_areas[tile] = group_sum(parts);
  }
}

}  // namespace coppice::twins
