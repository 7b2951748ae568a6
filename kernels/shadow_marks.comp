// In:  hits, and a light that casts shadows. Out: which hits need a shadow ray, see ShadowMarksArgs; exact on every
// device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/lights.h"
#include "lib/facing.glsl"
#include "lib/light_source.glsl"
#include "lib/ray_words.glsl"

layout(local_size_x = SHADOW_MARKS_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadowMarksArgs args; };

#include "lib/material_of.glsl"

bool reflects(uint ray, uint triangle, LightSource light) {
  vec3 diffuse = material_of(ray, triangle).diffuse;
  vec3 least = min(diffuse, light.radiance);  // in some channel both are there
  return max(max(least.x, least.y), least.z) > 0.0;
}

bool faces(Hit hit, vec3 direction, LightSource light) {
  Triangle triangle = args.triangles.at[hit.triangle];
  vec3 facing = facing_normal(triangle);
  float light_side = side_of(facing, towards(light, hit_point(triangle, hit.u, hit.v)));
  return side_of(facing, direction) > 0.0 ? light_side < 0.0 : light_side > 0.0;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Hit hit = load_hit(args.hits, i);
  LightSource light = args.lights.at[args.light];
  bool marked = hit.triangle != NO_TRIANGLE;
  if (marked) marked = reflects(i, hit.triangle, light) && faces(hit, args.rays.at[i].direction, light);
  args.marks.at[i] = marked ? 1u : 0u;
}
