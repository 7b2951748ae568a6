// In:  hits, and which of them ambient light reaches. Out: radiance, to which is added what they reflect of it, see
// ShadeAmbientArgs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/occlusion.h"
#include "lib/ray_words.glsl"

layout(local_size_x = SHADE_AMBIENT_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadeAmbientArgs args; };

#include "lib/material_of.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count || args.marks.at[i] == 0u) return;
  if (args.any_hits.at[args.places.at[i]] != 0u) return;
  vec3 diffuse = material_of(i, load_hit(args.hits, i).triangle).diffuse;
  precise vec3 sum = args.radiance.at[i] + diffuse * args.ambient.at[0].radiance;
  args.radiance.at[i] = sum;
}
