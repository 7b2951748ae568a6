// In:  one slice of the triangles, rays, their hits so far. Out: the closest hits. Tests every triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/trace_counters.glsl"
#include "lib/trace_ray.glsl"

layout(local_size_x = TRACE_GROUP) in;
layout(push_constant, scalar) uniform Push { TraceBruteForceArgs args; };
layout(constant_id = 0) const uint TRACE_TRIANGLE_TEST = TRIANGLE_FAST;  // as in the arguments

#include "lib/intersect_triangle.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool present = i < args.ray_count;
  bool has_hit = false;
  if (present) {
    Ray given = args.rays.at[i];
    Hit so_far = args.hits.at[i];
    TraceRay ray;
    if (prepare_ray(given, ray)) {
      Hit hit = prepared_hit(ray, so_far);
      uint last = args.first_triangle + args.triangle_count;
      [[dont_unroll]] for (uint k = args.first_triangle; k < last; ++k)
        intersect_triangle(ray, args.triangles.at[k], k, hit);
      keep_given(ray, given, hit, so_far);
      args.hits.at[i] = so_far;
    }
    has_hit = so_far.triangle != NO_TRIANGLE;
  }
  if (args.last_slice != 0u) {
    COUNT_INTO(args.counters.at[0].rays, present ? 1u : 0u)
    COUNT_INTO(args.counters.at[0].hits, has_hit ? 1u : 0u)
  }
  COUNT_INTO(args.counters.at[0].steps, present ? args.triangle_count : 0u)
}
