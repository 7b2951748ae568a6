#pragma once

#include <array>

#include "interface/wide.h"

namespace coppice::twins {

// Of a wide node rooted at `root` the children in their order: binary nodes, leaves with WIDE_LEAF; behind
// them WIDE_EMPTY. `nodes` is the whole tree.
std::array<uint, WIDE_CHILDREN> wide_children(Address<const Node> nodes, uint root);

// A level whose `count` nodes follow the first `first` ones, and its sums the words given.
WideLevel make_level(uint first, uint count, uint first_tile, uint first_block);

uint tile_count(const WideLevel& level);

// Workgroups of a dispatch of at least `groups`, in rows.
uvec3 rows_of_groups(uint groups);

// Writes the wide node that is the index-th of its level, and adds its children to the level's sums.
void enter_wide_node(const WideCollapseArgs& args, const WideLevel& level, uint index, uint root,
                     uint parent);

}  // namespace coppice::twins
