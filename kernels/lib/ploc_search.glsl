// The nearest neighbour of a cluster among normalised boxes in shared memory.
//
// Distance is the half area of the union box. Equal distances prefer the smaller gap in the list, then the parity
// rule: of the pairs (i - g, i) and (i, i + g), whose lower indices differ in the lowest set bit of g, the one that has
// it clear. Both clusters of a pair rank it alike, so the globally first pair is mutual and every round merges.
#include "lib/normalised.glsl"

// A box in 24 bytes, also where shared memory is laid out by std430, which would give a vec3 16.
shared vec4 tile_min_and_max_x[PLOC_TILE_BOXES];
shared vec2 tile_max_yz[PLOC_TILE_BOXES];

const float NO_AREA = 3.402823466e38;      // above every normalised area
const float FAR = 9.223372036854775808e18;  // 2^63: a box that reaches so far has an infinite area

void cache_box(uint slot, Node cluster, Normalisation normalisation) {
  vec3 box_max = normalised(cluster.box_max, normalisation);
  tile_min_and_max_x[slot] = vec4(normalised(cluster.box_min, normalisation), box_max.x);
  tile_max_yz[slot] = box_max.yz;
}

struct Box {
  vec3 box_min, box_max;
};

// The box at `slot`, or one that is nearest to nothing.
Box tile_box(uint slot, bool present) {
  if (!present) return Box(vec3(-FAR), vec3(FAR));
  vec4 low = tile_min_and_max_x[slot];
  return Box(low.xyz, vec3(low.w, tile_max_yz[slot]));
}

// Selected rather than min and max: those cost CPU devices three instructions each, for the sake of NaN.
float union_area(Box a, Box b) {
  vec3 box_min = mix(a.box_min, b.box_min, lessThan(b.box_min, a.box_min));
  vec3 box_max = mix(a.box_max, b.box_max, greaterThan(b.box_max, a.box_max));
  precise vec3 extent = box_max - box_min;
  precise float area = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
  return area;
}

// Of equal distances the smaller gap, then the parity rule.
uint nearer_side(uint i, float left_area, uint left_gap, float right_area, uint right_gap) {
  bool right_first = (i & left_gap & (~left_gap + 1u)) == 0u;
  bool tie_right = right_gap < left_gap || (right_gap == left_gap && right_first);
  bool take_right = right_area < left_area || (right_area == left_area && tie_right);
  return take_right ? i + right_gap : i - left_gap;
}

// Nearest neighbours of clusters i to i + PLOC_RUN - 1 of cluster_count, whose boxes start at `slot` of the tile with
// those of their neighbours beside them. A neighbour is read once for the whole run. On the left gaps come in
// descending order, on the right in ascending order, so <= and < keep the smaller gap.
void find_nearest(uint i, uint slot, uint cluster_count, uint radius, out uint nearest[PLOC_RUN]) {
  Box run[PLOC_RUN];
  float left_area[PLOC_RUN], right_area[PLOC_RUN];
  uint left_gap[PLOC_RUN], right_gap[PLOC_RUN];
  [[unroll]] for (uint k = 0u; k < PLOC_RUN; ++k) {
    run[k] = tile_box(slot + k, i + k < cluster_count);
    left_area[k] = right_area[k] = NO_AREA;
    left_gap[k] = right_gap[k] = 0u;
  }
  [[dont_unroll]] for (uint distance = radius; distance > 0u; --distance) {
    Box box = tile_box(slot - distance, distance <= i);
    [[unroll]] for (uint k = 0u; k < PLOC_RUN; ++k) {
      float area = union_area(box, run[k]);
      bool nearer = distance + k <= radius && area <= left_area[k];
      left_area[k] = nearer ? area : left_area[k];
      left_gap[k] = nearer ? distance + k : left_gap[k];
    }
  }
  [[unroll]] for (uint j = 0u; j < PLOC_RUN; ++j) {
    [[unroll]] for (uint k = 0u; k < PLOC_RUN; ++k) {
      if (k < j && j - k <= radius) {
        float area = union_area(run[k], run[j]);
        bool left_nearer = area <= left_area[j], right_nearer = area < right_area[k];
        left_area[j] = left_nearer ? area : left_area[j];
        left_gap[j] = left_nearer ? j - k : left_gap[j];
        right_area[k] = right_nearer ? area : right_area[k];
        right_gap[k] = right_nearer ? j - k : right_gap[k];
      }
    }
  }
  [[dont_unroll]] for (uint distance = 0u; distance < radius; ++distance) {
    uint j = PLOC_RUN + distance;
    Box box = tile_box(slot + j, i + j < cluster_count);
    [[unroll]] for (uint k = 0u; k < PLOC_RUN; ++k) {
      float area = union_area(run[k], box);
      bool nearer = j - k <= radius && area < right_area[k];
      right_area[k] = nearer ? area : right_area[k];
      right_gap[k] = nearer ? j - k : right_gap[k];
    }
  }
  [[unroll]] for (uint k = 0u; k < PLOC_RUN; ++k)
    nearest[k] = nearer_side(i + k, left_area[k], left_gap[k], right_area[k], right_gap[k]);
}
