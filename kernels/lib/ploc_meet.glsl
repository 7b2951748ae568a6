// Clusters in blocks, a cluster a lane, that meet those ahead of them in the list: nearest neighbours on both sides, each
// distance evaluated once. The including kernel defines RADIUS, a specialization constant.
#include "lib/ploc_box.glsl"
#include "lib/subgroup.glsl"

const uint BLOCKS_AHEAD = (RADIUS + LANES - 1u) / LANES;  // that a cluster may be nearest to
const uint BLOCKS_AT_ONCE = BLOCKS_AHEAD + 1u;

// What is known of the clusters of one block.
struct Block {
  Box box;
  Nearest left;  // complete when the block comes up
};

// In a row; the first one's clusters are looked at.
struct Blocks {
  Block at[BLOCKS_AT_ONCE];
};

void drop_first(inout Blocks blocks) {
  [[unroll]] for (uint k = 0u; k < BLOCKS_AHEAD; ++k) blocks.at[k] = blocks.at[k + 1u];
}

// The lane's box, `gap` lanes further on, of two blocks in a row.
Box box_ahead(Box near, Box next, uint gap) {
  bvec3 wrapped = bvec3(lane() < gap);
  uint from = (lane() + gap) % LANES;
  return Box(subgroupShuffle(mix(near.box_min, next.box_min, wrapped), from),
             subgroupShuffle(mix(near.box_max, next.box_max, wrapped), from));
}

// Of equal distances the earlier one stays: for one block gaps come in ascending order.
void take_nearer(inout Nearest nearest, bool met, float area, uint gap) {
  bool nearer = met && area < nearest.area;
  nearest.area = nearer ? area : nearest.area;
  nearest.gap = nearer ? gap : nearest.gap;
}

// The first block meets itself and those behind it. Returns the index of the nearest neighbour of its cluster i.
uint meet_blocks(uint i, inout Blocks blocks) {
  Nearest right = Nearest(NO_AREA, 0u), left[BLOCKS_AT_ONCE];
  [[unroll]] for (uint k = 0u; k <= BLOCKS_AHEAD; ++k) left[k] = right;
  [[unroll]] for (uint k = 0u; k < BLOCKS_AHEAD; ++k) {
    [[unroll]] for (uint step = 1u; step <= LANES; ++step) {
      uint gap = k * LANES + step;
      if (gap > RADIUS) break;
      float area = union_area(blocks.at[0].box, box_ahead(blocks.at[k].box, blocks.at[k + 1u].box, step));
      take_nearer(right, true, area, gap);
      float area_behind = subgroupShuffle(area, (lane() + LANES - step) % LANES);
      take_nearer(left[k], lane() >= step, area_behind, gap);
      take_nearer(left[k + 1u], lane() < step, area_behind, gap);
    }
  }
  // The gaps to this block are smaller than those to the blocks before it.
  [[unroll]] for (uint k = 0u; k <= BLOCKS_AHEAD; ++k) {
    bool nearer = left[k].area <= blocks.at[k].left.area;
    blocks.at[k].left.area = nearer ? left[k].area : blocks.at[k].left.area;
    blocks.at[k].left.gap = nearer ? left[k].gap : blocks.at[k].left.gap;
  }
  return nearer_side(i, blocks.at[0].left, right);
}
