// The nearest neighbour of a cluster among normalised boxes in shared memory.
//
// Distance is the half area of the union box. Equal distances prefer the smaller gap in the list, then the parity
// rule: of the pairs (i - g, i) and (i, i + g) the one whose lower index has bit floor(log2 g) clear, then the lower
// one. Every cluster ranks a pair the same way, so the globally first pair is always mutual and every round merges.
#include "lib/normalised.glsl"

shared vec3 tile_min[PLOC_TILE_BOXES];
shared vec3 tile_max[PLOC_TILE_BOXES];

const float NO_AREA = 3.402823466e38;  // above every normalised area

void cache_box(uint slot, Node cluster, Normalisation normalisation) {
  tile_min[slot] = normalised(cluster.box_min, normalisation);
  tile_max[slot] = normalised(cluster.box_max, normalisation);
}

float union_area(vec3 box_min, vec3 box_max, uint slot) {
  precise vec3 extent = max(box_max, tile_max[slot]) - min(box_min, tile_min[slot]);
  precise float area = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
  return area < AREA_FLOOR ? 0.0 : area;
}

// Cluster i of cluster_count, whose box is at `slot` of the tile; its neighbours lie beside it.
uint find_nearest(uint i, uint slot, uint cluster_count, uint radius) {
  vec3 box_min = tile_min[slot], box_max = tile_max[slot];
  float nearest_area = NO_AREA;
  uint nearest = i;
  [[dont_unroll]] for (uint gap = 1u; gap <= radius; ++gap) {
    bool has_left = i >= gap, has_right = i + gap < cluster_count;
    float left = has_left ? union_area(box_min, box_max, slot - gap) : NO_AREA;
    float right = has_right ? union_area(box_min, box_max, slot + gap) : NO_AREA;
    bool right_first = (((~i & (i - gap)) >> findMSB(gap)) & 1u) != 0u;
    bool take_right = right < left || (right == left && right_first);
    float area = min(left, right);
    if (area < nearest_area) {
      nearest_area = area;
      nearest = take_right ? i + gap : i - gap;
    }
  }
  return nearest;
}
