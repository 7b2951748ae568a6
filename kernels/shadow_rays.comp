// In:  hits, marks and their prefix sums. Out: the shadow rays of marked hits, see ShadowRaysArgs. They leave from the
// side that the camera sees, off the surface by the bound of offset_origin: none meets the triangle it starts from. To
// a point light t goes from 0 to 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/lights.h"
#include "lib/facing.glsl"
#include "lib/light_source.glsl"
#include "lib/offset_origin.glsl"
#include "lib/ray_words.glsl"

layout(local_size_x = SHADOW_RAYS_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadowRaysArgs args; };

Ray shadow_ray(Hit hit, vec3 direction, LightSource light) {
  Triangle triangle = args.triangles.at[hit.triangle];
  vec3 normal = normal_of(triangle);
  if (side_of(facing_normal(triangle), direction) > 0.0) normal = -normal;
  vec3 origin = offset_origin(triangle, hit.u, hit.v, normal);
  float far = light.kind == LIGHT_POINT ? 1.0 : uintBitsToFloat(0x7f800000u);
  return Ray(origin, 0.0, towards(light, origin), far);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  uint mark = args.marks.at[i], place = args.places.at[i];
  if (i + 1u == args.ray_count) args.shadow_count.at[0] = place + mark;
  if (mark == 0u) return;
  LightSource light = args.lights.at[args.light];
  store_ray(args.shadow_rays, place, shadow_ray(load_hit(args.hits, i), args.rays.at[i].direction, light));
}
