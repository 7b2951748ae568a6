// In:  triangles. Out: the box of each, the scene's box over the active ones and their number.
// A triangle with a non-finite corner is inactive: its box is empty and it touches nothing else.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/bounds.h"
#include "lib/count_error.glsl"
#include "lib/finite.glsl"
#include "lib/node_words.glsl"
#include "lib/scene_box.glsl"
#include "lib/subgroup_run.glsl"
#include "lib/triangle_words.glsl"

layout(local_size_x = PRIMITIVE_BOUNDS_GROUP) in;
layout(push_constant, scalar) uniform Push { PrimitiveBoundsArgs args; };

void main() {
  uint count = counted(args.count_at, args.triangle_count);
  if (gl_GlobalInvocationID.x == 0u) note_count(args.state, args.count_at, args.triangle_count);
  if (gl_WorkGroupID.x * PRIMITIVE_BOUNDS_TILE >= count) return;
  begin_tile();
  Extent extent = no_extent();
  Run run = subgroup_run(gl_WorkGroupID.x * PRIMITIVE_BOUNDS_TILE, PRIMITIVE_BOUNDS_PER_INVOCATION, count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    Triangle t = load_triangle(args.triangles, i);
    Aabb box = empty_box();
    if (finite(t.a) && finite(t.b) && finite(t.c)) {
      box = Aabb(min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c));
      add_box(extent, box);
    }
    store_box(args.boxes, i, box);
  }
  end_tile(extent, args.state);
}
