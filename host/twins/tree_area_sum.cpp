#include "twins/tree_area.h"

namespace coppice::twins {

void tree_area_sum(const TreeAreaSumArgs& args) {
  const uint leaves = args.state[0].active_count;
  args.refit[0].area_sum = args.refit[0].root_area = 0;
  if (leaves == 0) return;
  const uint tiles = (2 * leaves - 2) / TREE_AREAS_TILE + 1;
  std::array<float, TREE_AREAS_GROUP> parts{};
  for (uint tile = 0; tile < tiles; ++tile) parts[tile % TREE_AREAS_GROUP] += args.tile_areas[tile];
  args.refit[0].area_sum = group_sum(parts);
  args.refit[0].root_area = TreeArea(args.nodes[0])(args.nodes[0]);
}

}  // namespace coppice::twins
