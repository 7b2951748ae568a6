// In:  a queue of paths and what its rays have hit, fog, lights. Out: throughput behind the fog, radiance, and of each way
// through it a light and the ray to it; see PathFogArgs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/fog.h"
#include "lib/path.glsl"
#include "lib/sampler.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathFogArgs args; };
layout(constant_id = 0) const uint HAS_ENVIRONMENT = 1u;

#include "lib/fog.glsl"
#include "lib/light_sample.glsl"

uint fog_dimension(uint use) { return PATH_FOG_FIRST + args.bounce * PATH_FOG_DIMENSIONS + use; }

// `carried`: of the light that is scattered on the way what reaches the pixel.
void scatter_light(uint i, Path path, Ray ray, Fog fog, vec2 reach, float depth, vec3 carried) {
  precise float passed = 1.0 - sample_1d(path.seed, args.sample_index, fog_dimension(PATH_FOG_DEPTH)) * one_minus_exp(depth);
  precise float t = reach.x + min(minus_log(passed) / depth, 1.0) * (reach.y - reach.x);
  precise vec3 place = ray.origin + ray.direction * t;
  LightChoice choice =
      chosen_light(sample_1d(path.seed, args.sample_index, fog_dimension(PATH_FOG_PICKS_LIGHT)));
  vec2 u = sample_2d(path.seed, args.sample_index, fog_dimension(PATH_FOG_PLACES_LIGHT));
  vec2 in_texel = HAS_ENVIRONMENT != 0u
                      ? sample_2d(path.seed, args.sample_index, fog_dimension(PATH_FOG_PLACES_IN_TEXEL)) : vec2(0.0);
  LightSample light = light_of(choice, place, u, in_texel);
  float cosine = exact_dot(unit(ray.direction), unit(light.towards));
  precise vec3 colour = light.radiance * (fog_phase(fog.anisotropy, cosine) *
                                          fog_transmittance(fog, place, light.towards, light.t_max));
  if (!(max(max(colour.x, colour.y), colour.z) > 0.0)) return;
  if (choice.shadows == 0u) {
    add_radiance(args.radiance, path.pixel, carried, colour);
    return;
  }
  args.marks.at[i] = 1u;
  precise vec3 reaching = carried * colour;
  args.light_radiance.at[i] = reaching;
  store_ray(args.light_rays, i, Ray(place, 0.0, light.towards, light.t_max));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  args.marks.at[i] = 0u;
  if (i >= counted(args.count_at, args.ray_count)) return;
  Fog fog = fog_of(args.surroundings);
  Ray ray = load_ray(args.rays, i);
  Hit hit = load_hit(args.hits, i);
  float end = hit.triangle == NO_TRIANGLE ? uintBitsToFloat(0x7f800000u) : hit.t;
  vec2 reach = reach_of_fog(fog, ray.origin, ray.direction, end);
  float depth = fog_depth(fog, ray.direction, reach);
  if (!(depth > 0.0)) return;
  Path path = args.paths.at[i];
  precise vec3 through = path.throughput * exp_minus(depth);
  args.paths.at[i].throughput = through;
  precise vec3 carried = path.throughput * fog.albedo * one_minus_exp(depth);
  if (!(max(max(carried.x, carried.y), carried.z) > 0.0)) return;
  if (args.bounces_light == 0u) add_radiance(args.radiance, path.pixel, carried, args.surroundings.at[0].radiance);
  if (args.choice_count != 0u) scatter_light(i, path, ray, fog, reach, depth, carried);
}
