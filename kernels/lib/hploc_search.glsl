// Whom each cluster of a list is nearest to.
#include "lib/ploc_meet.glsl"

// Behind the end of the list: a box that is nearest to nothing.
Block load_block(uint i, List its, Normalisation normalisation, out uint slot) {
  bvec3 present = bvec3(i < its.count);
  slot = list[its.base + min(i, its.count - 1u)];
  Node cluster = node_of(cluster_words[slot]);
  Box box = Box(mix(vec3(-FAR), normalised(cluster.box_min, normalisation), present),
                mix(vec3(FAR), normalised(cluster.box_max, normalisation), present));
  return Block(box, Nearest(NO_AREA, 0u));
}

void find_nearest_boxes(List its, Normalisation normalisation) {
  Blocks blocks;
  uint slots[BLOCKS_AHEAD + 1u];
  [[unroll]] for (uint k = 0u; k < BLOCKS_AHEAD; ++k)
    blocks.at[k] = load_block(k * LANES + lane(), its, normalisation, slots[k]);
  [[dont_unroll]] for (uint first = 0u; first < its.count; first += LANES) {
    uint i = first + lane();
    blocks.at[BLOCKS_AHEAD] = load_block(i + BLOCKS_AHEAD * LANES, its, normalisation, slots[BLOCKS_AHEAD]);
    nearest[i] = slots[0] | meet_blocks(i, blocks) << 16;
    drop_first(blocks);
    [[unroll]] for (uint k = 0u; k < BLOCKS_AHEAD; ++k) slots[k] = slots[k + 1u];
  }
}
