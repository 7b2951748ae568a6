// In:  rays. Out: no hit yet for each of them, as traces of closest hits take them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/device_count.glsl"
#include "lib/ray_words.glsl"

layout(local_size_x = TRACE_GROUP) in;
layout(push_constant, scalar) uniform Push { TraceMissesArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= counted(args.count_at, args.ray_count)) return;
  store_hit(args.hits, i, Hit(load_ray(args.rays, i).t_max, NO_TRIANGLE, 0.0, 0.0));
}
