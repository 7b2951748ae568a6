// Whom each cluster of a list is nearest to.
#include "lib/ploc_box.glsl"

const uint BLOCKS_AHEAD = (RADIUS + LANES - 1u) / LANES;  // that a cluster may be nearest to

// What is known of as many clusters of the list as the subgroup is wide, a cluster a lane.
struct Block {
  uint slot;
  Box box;
  Nearest left;
};

// Behind the end of the list: a box that is nearest to nothing.
Block load_block(uint i, List its, Normalisation normalisation) {
  bvec3 present = bvec3(i < its.count);
  uint slot = list[its.base + min(i, its.count - 1u)];
  Node cluster = node_of(cluster_words[slot]);
  Box box = Box(mix(vec3(-FAR), normalised(cluster.box_min, normalisation), present),
                mix(vec3(FAR), normalised(cluster.box_max, normalisation), present));
  return Block(slot, box, Nearest(NO_AREA, 0u));
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

// Goes over the list in blocks. A box meets those of the blocks ahead by shuffles, each pair once, so that its distance
// serves both. A cluster's left side is complete when its block comes up.
void find_nearest_boxes(List its, Normalisation normalisation) {
  Block blocks[BLOCKS_AHEAD + 1u];
  [[unroll]] for (uint k = 0u; k < BLOCKS_AHEAD; ++k) blocks[k] = load_block(k * LANES + lane(), its, normalisation);
  [[dont_unroll]] for (uint first = 0u; first < its.count; first += LANES) {
    uint i = first + lane();
    blocks[BLOCKS_AHEAD] = load_block(i + BLOCKS_AHEAD * LANES, its, normalisation);
    Nearest right = Nearest(NO_AREA, 0u), left[BLOCKS_AHEAD + 1u];
    [[unroll]] for (uint k = 0u; k <= BLOCKS_AHEAD; ++k) left[k] = right;
    [[unroll]] for (uint k = 0u; k < BLOCKS_AHEAD; ++k) {
      [[unroll]] for (uint step = 1u; step <= LANES; ++step) {
        uint gap = k * LANES + step;
        if (gap > RADIUS) break;
        float area = union_area(blocks[0].box, box_ahead(blocks[k].box, blocks[k + 1u].box, step));
        take_nearer(right, true, area, gap);
        float area_behind = subgroupShuffle(area, (lane() + LANES - step) % LANES);
        take_nearer(left[k], lane() >= step, area_behind, gap);
        take_nearer(left[k + 1u], lane() < step, area_behind, gap);
      }
    }
    // The gaps to this block are smaller than those to the blocks before it.
    [[unroll]] for (uint k = 0u; k <= BLOCKS_AHEAD; ++k) {
      bool nearer = left[k].area <= blocks[k].left.area;
      blocks[k].left.area = nearer ? left[k].area : blocks[k].left.area;
      blocks[k].left.gap = nearer ? left[k].gap : blocks[k].left.gap;
    }
    nearest[i] = blocks[0].slot | nearer_side(i, blocks[0].left, right) << 16;
    [[unroll]] for (uint k = 0u; k < BLOCKS_AHEAD; ++k) blocks[k] = blocks[k + 1u];
  }
}
