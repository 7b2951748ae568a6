// A light for a point, of those that a stage of paths has in its args. Include after these, and the constant
// HAS_ENVIRONMENT, are declared. A directional light of radiance R has the irradiance pi R, a point too, so that both
// reflect as in shade_lights.
#include "lib/environment.glsl"
#include "lib/length.glsl"
#include "lib/light_source.glsl"
#include "lib/offset_origin.glsl"
#include "lib/texture_level.glsl"

struct LightSample {
  vec3 towards;  // from the point; not of unit length
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

// `u` places it on an emitter or in a texel of the environment, and `in_texel` there.
LightSample light_of(LightChoice choice, vec3 origin, vec2 u, vec2 in_texel) {
  if (HAS_ENVIRONMENT != 0u && choice.source == LIGHT_CHOICE_ENVIRONMENT) return environment_light(u, in_texel);
  if ((choice.source & LIGHT_CHOICE_LISTED) != 0u)
    return listed_light(args.lights.at[choice.source & ~LIGHT_CHOICE_LISTED], origin, choice.probability);
  return emitter_light(choice, origin, u);
}
