// In:  hits and the ambient light. Out: which hits need an occlusion ray, see OcclusionMarksArgs; exact everywhere.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/occlusion.h"
#include "lib/ray_words.glsl"

layout(local_size_x = OCCLUSION_MARKS_GROUP) in;
layout(push_constant, scalar) uniform Push { OcclusionMarksArgs args; };

#include "lib/material_of.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  uint triangle = load_hit(args.hits, i).triangle;
  vec3 least = vec3(0.0);
  // In some channel both are there.
  if (triangle != NO_TRIANGLE) least = min(material_of(i, triangle).diffuse, args.ambient.at[0].radiance);
  args.marks.at[i] = max(max(least.x, least.y), least.z) > 0.0 ? 1u : 0u;
}
