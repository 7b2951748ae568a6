// In:  light rays and what is in their way. Out: radiance, see PathLightAddArgs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/path.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathLightAddArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= counted(args.count_at, args.ray_count)) return;
  if (args.marks.at[i] == 0u || args.any_hits.at[args.places.at[i]] != 0u) return;
  add_radiance(args.radiance, args.paths.at[i].pixel, vec3(1.0), args.light_radiance.at[i]);
}
