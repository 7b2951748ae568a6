// In:  hits. Out: radiance, added up over the samples of a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/shade.h"
#include "lib/ray_words.glsl"
#include "lib/scene_light.glsl"

layout(local_size_x = SHADE_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadeArgs args; };
layout(constant_id = 0) const uint SHADE_DIRECTIONAL_LIGHT = 1u;  // 0 where the scene has none

#include "lib/material_of.glsl"

vec3 surface(uint i, Ray ray, uint index, Lighting lighting) {
  SurfaceMaterial material = material_of(i, index);
  if (SHADE_DIRECTIONAL_LIGHT == 0u) return material.ambient;
  return lit(material, args.triangles.at[index], ray.direction, lighting);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Ray ray = load_ray(args.rays, i);
  uint index = args.hits.at[i].triangle;
  Lighting lighting = args.lighting.at[0];
  vec3 colour = index == NO_TRIANGLE ? sky(ray.direction, lighting) : surface(i, ray, index, lighting);
  precise vec3 sum = colour;
  if (args.sample_index != 0u) sum = args.radiance.at[i] + colour;
  args.radiance.at[i] = sum;
}
