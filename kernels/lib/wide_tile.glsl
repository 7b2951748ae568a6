// The children of a tile of a level of the wide tree, which the including kernel's `args` tell.
#include "lib/subgroup.glsl"
#include "lib/wide_collapse.glsl"
#include "lib/wide_groups.glsl"

shared uint roots[WIDE_TILE * WIDE_CHILDREN];
shared uint parents[WIDE_TILE * WIDE_CHILDREN];
shared uint pairs[WIDE_TILE * WIDE_CHILDREN];  // below the roots

// This invocation's part of the sum over all tiles of the level before this one.
uint part_of_sum_before(WideLevel level, uint tile) {
  uint sum = 0u, block = tile / WIDE_BLOCK;
  [[dont_unroll]] for (uint b = lane(); b < block; b += LANES) sum += args.block_sums.at[level.first_block + b];
  [[dont_unroll]] for (uint t = block * WIDE_BLOCK + lane(); t < tile; t += LANES)
    sum += args.tile_sums.at[level.first_tile + t];
  return sum;
}

// Lists the roots of the children of entry `parent`, the first at `slot`.
void list_children(uint parent, uint slot) {
  [[dont_unroll]] for (uint c = 0u; c < WIDE_CHILDREN; ++c) {
    uint child = args.children.at[parent * WIDE_CHILDREN + c];
    if ((child & WIDE_LEAF) == 0u) {
      roots[slot] = child;
      parents[slot] = parent;
      ++slot;
    }
  }
}

// Children of the level before this tile.
uint sum_before(WideLevel level, uint tile) { return subgroupAdd(part_of_sum_before(level, tile)); }

// Children in the tile; they are in `roots` and `parents`.
uint list_tile(WideLevel level, uint tile, uint before) {
  uint listed = 0u;
  uint first = tile * WIDE_TILE, last = min(first + WIDE_TILE, level.count);
  [[dont_unroll]] for (uint at = first; at < last; at += LANES) {
    uint parent = level.first + at + lane();
    uint child_count = at + lane() < last ? args.entries.at[parent].child_count : 0u;
    uint sums = inclusive_add(child_count), slot = listed + sums - child_count;
    if (child_count != 0u) {
      args.entries.at[parent].first_child = level.first + level.count + before + slot;
      list_children(parent, slot);
    }
    listed += subgroupBroadcast(sums, LANES - 1u);
  }
  sync();
  return listed;
}

// Reads the roots and the pairs below them, so that they are in a cache. In collapse() a read waits for the one before;
// here those of many nodes are on their way at once.
void fetch_ahead(uint listed) {
  [[dont_unroll]] for (uint i = lane(); i < listed; i += LANES) pairs[i] = args.nodes.at[roots[i]].child;
  sync();
  [[dont_unroll]] for (uint i = lane(); i < listed; i += LANES) {
    uint heights = args.nodes.at[pairs[i]].height | args.nodes.at[pairs[i] + 1u].height;
    if (heights > 2u * WIDE_MAX_HEIGHT) roots[i] = 0u;  // never; without a use there would be no reads
  }
}

// Adds the children of nodes next to each other, one an invocation, to the sums of their level. `place` is in the level;
// `tile` and `block` are its first ones.
void add_children(uint place, uint child_count, uint tile, uint block) {
  uint own = place / WIDE_TILE, last = subgroupMax(own);
  [[dont_unroll]] for (uint t = subgroupMin(own); t <= last; ++t) {
    uint sum = subgroupAdd(own == t ? child_count : 0u);
    if (lane() == 0u) {
      // Partners: these lines, for the other nodes of the tile and the block. Sums do not depend on their order.
      atomicAdd(args.tile_sums.at[tile + t], sum);
      atomicAdd(args.block_sums.at[block + t / WIDE_BLOCK], sum);
    }
  }
}

// Of the level with this index; `before` children come before this tile, and as many as it returns before the next one.
// The last tile writes the next level.
uint collapse_tile(uint index, WideLevel level, uint tile, uint before) {
  uint tile_count = wide_tiles(level.count), listed = list_tile(level, tile, before), count = before + listed;
  uint next_first = level.first + level.count;
  uint next_tile = level.first_tile + tile_count;
  uint next_block = level.first_block + (tile_count + WIDE_BLOCK - 1u) / WIDE_BLOCK;
  if (LANES_IN_STEP) fetch_ahead(listed);
  Node root = args.nodes.at[0];
  Normalisation normalisation = normalisation_of(root.box_min, root.box_max);
  [[dont_unroll]] for (uint i = lane(); i < listed; i += LANES) {
    uint place = before + i, child_count = enter(next_first + place, roots[i], parents[i], normalisation);
    add_children(place, child_count, next_tile, next_block);
  }
  if (tile + 1u != tile_count || lane() != 0u) return count;
  args.levels.at[index + 1u] = planned_level(next_first, count, next_tile, next_block);
  if (count == 0u) {
    uvec3 groups = wide_rows((next_first + WIDE_GROUP - 1u) / WIDE_GROUP);
    args.counts.at[0] = WideCounts(next_first, index + 1u, groups, 0u, 0u, 0u);
  }
  return count;
}
