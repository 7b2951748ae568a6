// In:  nothing. Out: a path for each camera ray, and radiance to add to; see PathStartArgs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/path.glsl"
#include "lib/random.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathStartArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  if (i == 0u) args.count.at[0] = args.ray_count;
  if (args.sample_index == 0u) args.radiance.at[i] = vec3(0.0);
  uint seed = uint64_t(args.pixels) == 0ul ? args.first_ray + i : args.pixels.at[i];
  args.paths.at[i] = Path(vec3(1.0), i, 0.0, 0u, next_random(seed), 0u);
}
