// In:  a queue of paths, their surfaces, lights. Out: a light for each, and the ray to it; see PathLightsArgs. A
// directional light of radiance R has the irradiance pi R, a point too, so that both reflect as in shade_lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/path.glsl"
#include "lib/light_source.glsl"
#include "lib/offset_origin.glsl"
#include "lib/sampler.glsl"
#include "lib/texture_level.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathLightsArgs args; };
layout(constant_id = 0) const uint BSDF_DIFFUSE_LOBE = 1u;
layout(constant_id = 1) const uint BSDF_REFLECTS = 1u;
layout(constant_id = 2) const uint BSDF_TRANSMITS = 1u;
layout(constant_id = 3) const uint HAS_ENVIRONMENT = 1u;

#include "lib/bsdf.glsl"
#include "lib/environment.glsl"

struct LightSample {
  vec3 towards;  // from the surface; not of unit length
  float t_max;   // in units of it
  vec3 radiance;  // by the density
  float pdf;      // by solid angle, 0: paths cannot meet it
};

LightChoice chosen_light(float u) {
  uint at = uint(u * float(LIGHT_CHOICE_RANGE)), first = 0u, last = args.choice_count - 1u;
  [[dont_unroll]] for (uint step = 0u; step < 32u && first < last; ++step) {
    uint middle = (first + last) >> 1;
    if (args.choices.at[middle].end > at) {
      last = middle;
    } else {
      first = middle + 1u;
    }
  }
  return args.choices.at[first];
}

float length_of(vec3 v) {
  vec3 size = abs(v);
  float largest = max(max(size.x, size.y), size.z);
  if (largest == 0.0) return 0.0;
  precise vec3 scaled = v / largest;
  precise float length = largest * sqrt(exact_dot(scaled, scaled));
  return length;
}

LightSample listed_light(LightSource light, vec3 origin, float probability) {
  vec3 direction = towards(light, origin);
  precise vec3 radiance = light.radiance * PI / probability;
  if (light.kind == LIGHT_DIRECTIONAL) return LightSample(direction, uintBitsToFloat(0x7f800000u), radiance, 0.0);
  float distance = length_of(direction);
  if (distance == 0.0) return LightSample(direction, 1.0, vec3(0.0), 0.0);
  precise float nearness = light.distance / distance;
  precise vec3 fallen = radiance * (nearness * nearness);
  return LightSample(direction, 1.0, fallen, 0.0);
}

// Uniform on the triangle: Turk 1990, "Generating Random Points in Triangles".
LightSample emitter_light(LightChoice choice, vec3 origin, vec2 u) {
  LightSample none = LightSample(vec3(0.0), 1.0, vec3(0.0), 0.0);
  Triangle triangle = args.triangles.at[choice.source];
  precise float root = sqrt(u.x);
  precise float b = root * (1.0 - u.y), c = root * u.y;
  vec3 normal = normal_of(triangle);
  precise vec3 to_point = hit_point(triangle, b, c) - origin;
  vec3 near = exact_dot(normal, to_point) > 0.0 ? -normal : normal;
  precise vec3 direction = offset_origin(triangle, b, c, near) - origin;
  float distance = length_of(direction), cosine = abs(exact_dot(normal, unit(direction)));
  precise float area = 0.5 * twice_area(triangle);
  if (!(distance > 0.0 && cosine > 0.0 && area > 0.0)) return none;
  precise float pdf = choice.probability * (distance * distance) / (area * cosine);
  if (!(pdf > 0.0 && is_number(pdf))) return none;
  precise vec3 radiance = choice.emission / pdf;
  return LightSample(direction, 1.0, radiance, pdf);
}

LightSample environment_light(vec2 u, vec2 in_texel) {
  EnvironmentSample met = sampled_environment(args.surroundings, u, in_texel);
  if (!(met.density > 0.0)) return LightSample(met.towards, 1.0, vec3(0.0), 0.0);
  precise vec3 radiance = met.radiance / met.density;
  return LightSample(met.towards, uintBitsToFloat(0x7f800000u), radiance, met.density);
}

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

LightSample light_of(LightChoice choice, Path path, vec3 origin) {
  vec2 u = sample_2d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_PLACES_LIGHT));
  if (HAS_ENVIRONMENT != 0u && choice.source == LIGHT_CHOICE_ENVIRONMENT)
    return environment_light(u, sample_2d(path.seed, args.sample_index, PATH_PLACES_IN_TEXEL + args.bounce));
  if ((choice.source & LIGHT_CHOICE_LISTED) != 0u)
    return listed_light(args.lights.at[choice.source & ~LIGHT_CHOICE_LISTED], origin, choice.probability);
  return emitter_light(choice, origin, u);
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
  LightSample light = light_of(choice, path, origin);
  precise vec3 colour = reflected(surface, -unit(direction), light) * light.radiance;
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
