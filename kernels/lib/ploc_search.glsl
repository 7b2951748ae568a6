// The nearest neighbour of a cluster among the normalised boxes of all of them in shared memory. The including kernel
// defines PLOC_BOXES, how many there may be.
#include "lib/ploc_box.glsl"

// A box in 24 bytes, also where shared memory is laid out by std430, which would give a vec3 16.
shared vec4 boxes_min_and_max_x[PLOC_BOXES];
shared vec2 boxes_max_yz[PLOC_BOXES];

void cache_box(uint i, Node cluster, Normalisation normalisation) {
  vec3 box_max = normalised(cluster.box_max, normalisation);
  boxes_min_and_max_x[i] = vec4(normalised(cluster.box_min, normalisation), box_max.x);
  boxes_max_yz[i] = box_max.yz;
}

// The box of cluster i, or one that is nearest to nothing.
Box cached_box(uint i, bool present) {
  if (!present) return Box(vec3(-FAR), vec3(FAR));
  vec4 low = boxes_min_and_max_x[i];
  return Box(low.xyz, vec3(low.w, boxes_max_yz[i]));
}

uint find_nearest(uint i, uint cluster_count, uint radius) {
  Box own = cached_box(i, true);
  Nearest left = Nearest(NO_AREA, 0u), right = left;
  [[dont_unroll]] for (uint gap = 1u; gap <= radius; ++gap) {
    float left_area = union_area(cached_box(i - gap, gap <= i), own);
    float right_area = union_area(own, cached_box(i + gap, i + gap < cluster_count));
    if (left_area < left.area) left = Nearest(left_area, gap);
    if (right_area < right.area) right = Nearest(right_area, gap);
  }
  return nearer_side(i, left, right);
}
