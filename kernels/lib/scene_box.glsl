// The scene's box and the number of its active primitives, over all workgroups.
#include "lib/extent.glsl"

shared Extent tile_extent;

// By the whole workgroup, before anything else.
void begin_tile() {
  if (gl_LocalInvocationIndex == 0u) tile_extent = no_extent();
  barrier();
}

// By the whole workgroup: adds what its invocations have seen to the state.
void end_tile(Extent extent, BuildStateBuffer state) {
  extent = subgroup_extent(extent);
  if (subgroupElect()) {  // partners: the other subgroups of this workgroup
    for (int axis = 0; axis < 3; ++axis) {
      atomicMax(tile_extent.min_complement[axis], extent.min_complement[axis]);
      atomicMax(tile_extent.box_max[axis], extent.box_max[axis]);
    }
    atomicAdd(tile_extent.active_count, extent.active_count);
  }
  barrier();
  uint lane = gl_LocalInvocationIndex;
  if (lane < 3u) {  // partners: the other workgroups
    atomicMax(state.at[0].box_min_complement[lane], tile_extent.min_complement[lane]);
    atomicMax(state.at[0].box_max[lane], tile_extent.box_max[lane]);
  } else if (lane == 3u) {
    atomicAdd(state.at[0].active_count, tile_extent.active_count);
  }
}
