// The box about some primitives, and their number. Floats are compared as integers in the same order; the minimum is kept
// as its complement, so that zeroes are the neutral value of both.
#include "lib/ordered_float.glsl"

struct Extent {
  uvec3 min_complement, box_max;
  uint active_count;
};

Aabb empty_box() { return Aabb(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u))); }

Extent no_extent() { return Extent(uvec3(0u), uvec3(0u), 0u); }

void add_box(inout Extent extent, Aabb box) {
  extent.min_complement = max(extent.min_complement, ~ordered(box.box_min));
  extent.box_max = max(extent.box_max, ordered(box.box_max));
  ++extent.active_count;
}

// Of all invocations of the subgroup.
Extent subgroup_extent(Extent extent) {
  return Extent(subgroupMax(extent.min_complement), subgroupMax(extent.box_max), subgroupAdd(extent.active_count));
}
