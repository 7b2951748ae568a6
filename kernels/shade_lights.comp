// In:  hits, lights, and of one that casts shadows which hits it reaches. Out: radiance, to which is added what surfaces
// reflect of them, see ShadeLightsArgs. Flat and diffuse, as shade; the light of a point falls off with the square of
// the distance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/lights.h"
#include "lib/exact_vector.glsl"
#include "lib/length.glsl"
#include "lib/light_source.glsl"
#include "lib/ray_words.glsl"

layout(local_size_x = SHADE_LIGHTS_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadeLightsArgs args; };
layout(constant_id = 0) const uint SHADE_SHADOWS = 1u;
layout(constant_id = 1) const uint SHADE_POINTS = 1u;

#include "lib/material_of.glsl"

vec3 reflected(vec3 diffuse, LightSource light, vec3 point, vec3 normal) {
  precise vec3 colour = diffuse * light.radiance;
  if (SHADE_POINTS == 0u || light.kind == LIGHT_DIRECTIONAL) {
    float cosine = max(exact_dot(normal, light.place), 0.0);
    precise vec3 lit = colour * cosine;
    return lit;
  }
  vec3 direction = towards(light, point);
  float distance = length_of(direction);
  if (distance == 0.0) return vec3(0.0);
  float cosine = max(exact_dot(normal, unit(direction)), 0.0);
  precise float nearness = light.distance / distance;
  precise vec3 lit = colour * (cosine * (nearness * nearness));
  return lit;
}

bool is_reached(uint i) {
  if (SHADE_SHADOWS == 0u) return true;
  return args.marks.at[i] != 0u && args.any_hits.at[args.places.at[i]] == 0u;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Hit hit = load_hit(args.hits, i);
  if (hit.triangle == NO_TRIANGLE || !is_reached(i)) return;
  Triangle triangle = args.triangles.at[hit.triangle];
  vec3 diffuse = material_of(i, hit.triangle).diffuse;
  vec3 normal = normal_of(triangle);
  if (exact_dot(normal, args.rays.at[i].direction) > 0.0) normal = -normal;
  vec3 point = hit_point(triangle, hit.u, hit.v);
  vec3 sum = args.radiance.at[i];
  [[dont_unroll]] for (uint k = 0u; k < args.light_count; ++k) {
    precise vec3 more = sum + reflected(diffuse, args.lights.at[args.first_light + k], point, normal);
    sum = more;
  }
  args.radiance.at[i] = sum;
}
