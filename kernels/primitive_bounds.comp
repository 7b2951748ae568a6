// In:  triangles. Out: the box of each, the scene's box over the active ones and their number.
// A triangle with a non-finite corner is inactive: its box is empty and it touches nothing else.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/bounds.h"
#include "lib/count_error.glsl"
#include "lib/ordered_float.glsl"
#include "lib/node_words.glsl"
#include "lib/subgroup_run.glsl"
#include "lib/triangle_words.glsl"

layout(local_size_x = PRIMITIVE_BOUNDS_GROUP) in;
layout(push_constant, scalar) uniform Push { PrimitiveBoundsArgs args; };

shared uvec3 tile_min_complement;
shared uvec3 tile_max;
shared uint tile_active;

bool finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool finite(vec3 v) { return finite(v.x) && finite(v.y) && finite(v.z); }

void reduce_into_tile(uvec3 min_complement, uvec3 box_max, uint active_count) {
  min_complement = subgroupMax(min_complement);
  box_max = subgroupMax(box_max);
  active_count = subgroupAdd(active_count);
  if (subgroupElect()) {  // partners: the other subgroups of this workgroup
    for (int axis = 0; axis < 3; ++axis) {
      atomicMax(tile_min_complement[axis], min_complement[axis]);
      atomicMax(tile_max[axis], box_max[axis]);
    }
    atomicAdd(tile_active, active_count);
  }
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint count = counted(args.count_at, args.triangle_count);
  if (gl_GlobalInvocationID.x == 0u) note_count(args.state, args.count_at, args.triangle_count);
  if (gl_WorkGroupID.x * PRIMITIVE_BOUNDS_TILE >= count) return;
  if (lane == 0u) {
    tile_min_complement = uvec3(0u);
    tile_max = uvec3(0u);
    tile_active = 0u;
  }
  barrier();

  uvec3 min_complement = uvec3(0u), box_max = uvec3(0u);
  uint active_count = 0u;
  Run run = subgroup_run(gl_WorkGroupID.x * PRIMITIVE_BOUNDS_TILE, PRIMITIVE_BOUNDS_PER_INVOCATION, count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    Triangle t = load_triangle(args.triangles, i);
    Aabb box = Aabb(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u)));
    if (finite(t.a) && finite(t.b) && finite(t.c)) {
      box = Aabb(min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c));
      min_complement = max(min_complement, ~ordered(box.box_min));
      box_max = max(box_max, ordered(box.box_max));
      ++active_count;
    }
    store_box(args.boxes, i, box);
  }
  reduce_into_tile(min_complement, box_max, active_count);
  barrier();

  if (lane < 3u) {  // partners: the other workgroups
    atomicMax(args.state.at[0].box_min_complement[lane], tile_min_complement[lane]);
    atomicMax(args.state.at[0].box_max[lane], tile_max[lane]);
  } else if (lane == 3u) {
    atomicAdd(args.state.at[0].active_count, tile_active);
  }
}
