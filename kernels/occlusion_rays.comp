// In:  hits, marks and their prefix sums. Out: the occlusion rays of marked hits, see OcclusionRaysArgs. Distributed by
// the cosine, as light from all sides counts, so that a ray that nothing stops is worth all of it: Zhukov, Iones,
// Kronin 1998, "An Ambient Light Illumination Model". They leave as shadow rays do.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/occlusion.h"
#include "lib/bsdf_directions.glsl"
#include "lib/facing.glsl"
#include "lib/offset_origin.glsl"
#include "lib/ray_words.glsl"
#include "lib/sampler.glsl"

layout(local_size_x = OCCLUSION_RAYS_GROUP) in;
layout(push_constant, scalar) uniform Push { OcclusionRaysArgs args; };

Ray occlusion_ray(Hit hit, vec3 direction, uint pixel) {
  Triangle triangle = args.triangles.at[hit.triangle];
  vec3 normal = normal_of(triangle);
  if (side_of(facing_normal(triangle), direction) > 0.0) normal = -normal;
  vec3 away = bsdf_diffuse_direction(normal, sample_2d(pixel, args.sample_index, SAMPLE_OCCLUSION));
  return Ray(offset_origin(triangle, hit.u, hit.v, normal), 0.0, away, args.ambient.at[0].distance);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  uint mark = args.marks.at[i], place = args.places.at[i];
  if (i + 1u == args.ray_count) args.ray_counter.at[0] = place + mark;
  if (mark == 0u) return;
  uint pixel = uint64_t(args.pixels) == 0ul ? args.first_ray + i : args.pixels.at[i];
  store_ray(args.occlusion_rays, place, occlusion_ray(load_hit(args.hits, i), args.rays.at[i].direction, pixel));
}
