// In:  a queue of paths, their surfaces, lights. Out: a light for each, and the ray to it; see PathLightsArgs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/path.glsl"
#include "lib/sampler.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathLightsArgs args; };
layout(constant_id = 0) const uint BSDF_DIFFUSE_LOBE = 1u;
layout(constant_id = 1) const uint BSDF_REFLECTS = 1u;
layout(constant_id = 2) const uint BSDF_TRANSMITS = 1u;
layout(constant_id = 3) const uint HAS_ENVIRONMENT = 1u;
layout(constant_id = 4) const uint HAS_FOG = 1u;

#include "lib/bsdf.glsl"
#include "lib/fog.glsl"
#include "lib/light_sample.glsl"

// BSDF and cosine, of what paths could meet as well its share.
vec3 reflected(SurfacePoint surface, vec3 view, LightSample light) {
  BsdfTerms terms = bsdf_terms(surface, view, unit(light.towards));
  vec3 both = bsdf_sampled(terms);
  precise vec3 all = terms.diffuse + terms.glossy;
  if (light.pdf == 0.0 || (args.lobes & PATH_LAST_BOUNCE) != 0u) return all;
  precise float ratio = terms.pdf / light.pdf;
  precise vec3 shared_out = (all - both) + both * power_weight(ratio);
  return shared_out;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  args.marks.at[i] = 0u;
  if (i >= counted(args.count_at, args.ray_count)) return;
  Hit hit = load_hit(args.hits, i);
  if (hit.triangle == NO_TRIANGLE) return;
  Path path = args.paths.at[i];
  SurfacePoint surface = args.surfaces.at[i];
  vec3 direction = args.rays.at[i].direction;
  Triangle triangle = args.triangles.at[hit.triangle];
  vec3 origin = offset_origin(triangle, hit.u, hit.v, normal_towards(triangle, direction));
  LightChoice choice =
      chosen_light(sample_1d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_PICKS_LIGHT)));
  vec2 u = sample_2d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_PLACES_LIGHT));
  vec2 in_texel =
      HAS_ENVIRONMENT != 0u ? sample_2d(path.seed, args.sample_index, PATH_PLACES_IN_TEXEL + args.bounce) : vec2(0.0);
  LightSample light = light_of(choice, origin, u, in_texel);
  precise vec3 colour = reflected(surface, -unit(direction), light) * light.radiance;
  if (HAS_FOG != 0u) {
    precise vec3 through =
        colour * fog_transmittance(fog_of(args.surroundings), origin, light.towards, light.t_max);
    colour = through;
  }
  if (!(max(max(colour.x, colour.y), colour.z) > 0.0)) return;
  if (choice.shadows == 0u) {
    add_radiance(args.radiance, path.pixel, path.throughput, colour);
    return;
  }
  args.marks.at[i] = 1u;
  precise vec3 reaching = path.throughput * colour;
  args.light_radiance.at[i] = reaching;
  store_ray(args.light_rays, i, Ray(origin, 0.0, light.towards, light.t_max));
}
