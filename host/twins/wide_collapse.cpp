#include "twins/wide_levels.h"

namespace coppice::twins {

void wide_collapse(const WideCollapseArgs& args) {
  const WideLevel level = args.levels[args.level];
  const uint blocks = (tile_count(level) + WIDE_BLOCK - 1) / WIDE_BLOCK;
  const uint end = level.first + level.count;
  WideLevel next{end, 0, level.first_tile + tile_count(level), level.first_block + blocks, {}, 0};
  for (uint parent = level.first; parent < end; ++parent) {
    WideEntry& entry = args.entries[parent];
    if (entry.child_count == 0) continue;
    entry.first_child = end + next.count;
    for (uint c = 0; c < WIDE_CHILDREN; ++c) {
      const uint child = args.children[std::size_t{parent} * WIDE_CHILDREN + c];
      if (child < WIDE_LEAF) enter_wide_node(args, next, next.count++, child, parent);
    }
  }
  args.levels[args.level + 1] = make_level(next.first, next.count, next.first_tile, next.first_block);
  if (next.count == 0)
    args.counts[0] = {end, args.level + 1, rows_of_groups((end + WIDE_GROUP - 1) / WIDE_GROUP), 0, 0, 0};
}

}  // namespace coppice::twins
