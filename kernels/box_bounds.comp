// In:  boxes of primitives that nobody else knows. Out: as primitive_bounds of triangles: the box of each, the scene's box
// over the active ones and their number. Coordinates that are denormal or -0 become +0.
// A box that is not finite or whose minimum is above its maximum is inactive: it becomes empty and touches nothing else.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/bounds.h"
#include "lib/count_error.glsl"
#include "lib/finite.glsl"
#include "lib/node_words.glsl"
#include "lib/scene_box.glsl"
#include "lib/subgroup_run.glsl"

layout(local_size_x = PRIMITIVE_BOUNDS_GROUP) in;
layout(push_constant, scalar) uniform Push { BoxBoundsArgs args; };

Aabb load_given(uint i) {
  UintBuffer words = UintBuffer(uint64_t(args.given) + uint64_t(i) * args.stride);
  return Aabb(flushed(uintBitsToFloat(uvec3(words.at[0], words.at[1], words.at[2]))),
              flushed(uintBitsToFloat(uvec3(words.at[3], words.at[4], words.at[5]))));
}

bool is_active(Aabb box) {
  return finite(box.box_min) && finite(box.box_max) && all(lessThanEqual(box.box_min, box.box_max));
}

void main() {
  uint count = counted(args.count_at, args.box_count);
  if (gl_GlobalInvocationID.x == 0u) note_count(args.state, args.count_at, args.box_count);
  if (gl_WorkGroupID.x * PRIMITIVE_BOUNDS_TILE >= count) return;
  begin_tile();
  Extent extent = no_extent();
  Run run = subgroup_run(gl_WorkGroupID.x * PRIMITIVE_BOUNDS_TILE, PRIMITIVE_BOUNDS_PER_INVOCATION, count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    Aabb box = load_given(i);
    if (is_active(box)) add_box(extent, box);
    else box = empty_box();
    store_box(args.boxes, i, box);
  }
  end_tile(extent, args.state);
}
