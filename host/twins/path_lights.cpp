#include <cmath>
#include <limits>
#include <optional>

#include "twins/bsdf.h"
#include "twins/environment.h"
#include "twins/leave_surface.h"
#include "twins/light_source.h"
#include "twins/paths.h"
#include "twins/sampler.h"
#include "twins/texture.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

struct SampledLight {
  vec3 towards;
  float t_max;
  vec3 radiance;  // by the density
  float pdf;      // by solid angle; 0 where no path meets it
};

float distance_along(const vec3& v) {
  const float largest = std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  if (largest == 0) return 0;
  const vec3 scaled(v.x / largest, v.y / largest, v.z / largest);
  return largest * std::sqrt(dot_product(scaled, scaled));
}

const LightChoice& choice_for(const PathLightsArgs& args, float u) {
  const auto at = static_cast<uint>(u * static_cast<float>(LIGHT_CHOICE_RANGE));
  uint i = 0;
  while (i + 1 < args.choice_count && args.choices[i].end <= at) ++i;
  return args.choices[i];
}

std::optional<SampledLight> sample_listed(const LightSource& light, const vec3& origin, float probability) {
  const vec3 direction = light_direction(light, origin);
  const vec3 radiance = light.radiance * PI_FLOAT / probability;
  if (light.kind != LIGHT_POINT)
    return SampledLight{direction, std::numeric_limits<float>::infinity(), radiance, 0};
  const float distance = distance_along(direction);
  if (distance == 0) return std::nullopt;
  const float nearness = light.distance / distance;
  return SampledLight{direction, 1, radiance * (nearness * nearness), 0};
}

// Uniform on the triangle: Turk 1990.
std::optional<SampledLight> sample_emitter(const PathLightsArgs& args, const LightChoice& choice,
                                           const vec3& origin, const glm::vec2& u) {
  const Triangle& triangle = args.triangles[choice.source];
  const float root = std::sqrt(u.x);
  const Hit place{0, choice.source, root * (1.0f - u.y), root * u.y};
  const vec3 normal = unit_normal(triangle);
  const bool from_behind = dot_product(normal, hit_point(triangle, place) - origin) > 0;
  const vec3 direction = leave_surface(triangle, place, from_behind ? -normal : normal) - origin;
  const float distance = distance_along(direction);
  const float cosine = std::fabs(dot_product(normal, unit_vector(direction)));
  const float area = 0.5f * twice_area(triangle);
  if (!(distance > 0) || !(cosine > 0) || !(area > 0)) return std::nullopt;
  const float pdf = choice.probability * (distance * distance) / (area * cosine);
  if (!(pdf > 0) || !std::isfinite(pdf)) return std::nullopt;
  return SampledLight{direction, 1, choice.emission / pdf, pdf};
}

std::optional<SampledLight> sample_environment_light(const PathLightsArgs& args, const Path& path,
                                                     const glm::vec2& u) {
  const EnvironmentSample met = sample_environment(
      args.surroundings, u, sample_2d(path.seed, args.sample_index, PATH_PLACES_IN_TEXEL + args.bounce));
  if (!(met.light.density > 0)) return std::nullopt;
  return SampledLight{met.towards, std::numeric_limits<float>::infinity(),
                      met.light.radiance / met.light.density, met.light.density};
}

std::optional<SampledLight> sample_choice(const PathLightsArgs& args, const LightChoice& choice,
                                          const Path& path, const vec3& origin) {
  const glm::vec2 u = sample_2d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_PLACES_LIGHT));
  if (choice.source == LIGHT_CHOICE_ENVIRONMENT) return sample_environment_light(args, path, u);
  if ((choice.source & LIGHT_CHOICE_LISTED) != 0)
    return sample_listed(args.lights[choice.source & ~LIGHT_CHOICE_LISTED], origin, choice.probability);
  return sample_emitter(args, choice, origin, u);
}

vec3 reflected_towards(const SurfacePoint& surface, const vec3& view, const SampledLight& light, uint lobes) {
  const BsdfSwitches switches = switches_of(lobes);
  const BsdfTerms terms = bsdf_terms(surface, view, unit_vector(light.towards), switches);
  const vec3 all = terms.diffuse + terms.glossy;
  if (light.pdf == 0 || (lobes & PATH_LAST_BOUNCE) != 0) return all;
  const vec3 both = bsdf_sampled(terms, switches);
  return (all - both) + both * power_weight(terms.pdf / light.pdf);
}

}  // namespace

void path_lights(const PathLightsArgs& args) {
  const uint count = paths_in_queue(args.count_at, args.ray_count);
  for (uint i = 0; i < args.ray_count; ++i) {
    args.marks[i] = 0;
    if (i >= count || args.hits[i].triangle == NO_TRIANGLE) continue;
    const Path& path = args.paths[i];
    const vec3& direction = args.rays[i].direction;
    const Triangle& triangle = args.triangles[args.hits[i].triangle];
    const vec3 origin = leave_surface(triangle, args.hits[i], normal_towards(triangle, direction));
    const LightChoice& choice = choice_for(
        args, sample_1d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_PICKS_LIGHT)));
    const auto light = sample_choice(args, choice, path, origin);
    if (!light) continue;
    const vec3 colour =
        reflected_towards(args.surfaces[i], -unit_vector(direction), *light, args.lobes) * light->radiance;
    if (!(std::fmax(std::fmax(colour.x, colour.y), colour.z) > 0)) continue;
    if (choice.shadows == 0) {
      args.radiance[path.pixel] += path.throughput * colour;
      continue;
    }
    args.marks[i] = 1;
    args.light_radiance[i] = path.throughput * colour;
    args.light_rays[i] = {origin, 0, light->towards, light->t_max};
  }
}

}  // namespace coppice::twins
