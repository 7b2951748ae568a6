// In:  one slice of the triangles, rays, their hits so far. Out: the closest hits. Tests every triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/intersect_triangle.glsl"
#include "lib/trace_counters.glsl"

layout(local_size_x = TRACE_GROUP) in;
layout(push_constant, scalar) uniform Push { TraceBruteForceArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool present = i < args.ray_count;
  bool has_hit = false;
  if (present) {
    Ray ray = args.rays.at[i];
    Hit hit = args.hits.at[i];
    uint last = can_hit(ray) ? args.first_triangle + args.triangle_count : args.first_triangle;
    [[dont_unroll]] for (uint k = args.first_triangle; k < last; ++k)
      intersect_triangle(ray, args.triangles.at[k], k, hit);
    args.hits.at[i] = hit;
    has_hit = hit.triangle != NO_TRIANGLE;
  }
  if (args.last_slice != 0u) {
    COUNT_INTO(args.counters.at[0].rays, present ? 1u : 0u)
    COUNT_INTO(args.counters.at[0].hits, has_hit ? 1u : 0u)
  }
  COUNT_INTO(args.counters.at[0].steps, present ? args.triangle_count : 0u)
}
