#include "twins/light_sample.h"

#include <cmath>
#include <limits>

#include "twins/environment.h"
#include "twins/leave_surface.h"
#include "twins/light_source.h"
#include "twins/paths.h"
#include "twins/texture.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

std::optional<SampledLight> sample_listed(const LightSource& light, const vec3& origin, float probability) {
  const vec3 direction = light_direction(light, origin);
  const vec3 radiance = light.radiance * PI_FLOAT / probability;
  if (light.kind != LIGHT_POINT)
    return SampledLight{direction, std::numeric_limits<float>::infinity(), radiance, 0};
  const float distance = length_of(direction);
  if (distance == 0) return std::nullopt;
  const float nearness = light.distance / distance;
  return SampledLight{direction, 1, radiance * (nearness * nearness), 0};
}

// Uniform on the triangle: Turk 1990.
std::optional<SampledLight> sample_emitter(const LightTables& tables, const LightChoice& choice,
                                           const vec3& origin, const glm::vec2& u) {
  const Triangle& triangle = tables.triangles[choice.source];
  const float root = std::sqrt(u.x);
  const Hit place{0, choice.source, root * (1.0f - u.y), root * u.y};
  const vec3 normal = unit_normal(triangle);
  const bool from_behind = dot_product(normal, hit_point(triangle, place) - origin) > 0;
  const vec3 direction = leave_surface(triangle, place, from_behind ? -normal : normal) - origin;
  const float distance = length_of(direction);
  const float cosine = std::fabs(dot_product(normal, unit_vector(direction)));
  const float area = 0.5f * twice_area(triangle);
  if (!(distance > 0) || !(cosine > 0) || !(area > 0)) return std::nullopt;
  const float pdf = choice.probability * (distance * distance) / (area * cosine);
  if (!(pdf > 0) || !std::isfinite(pdf)) return std::nullopt;
  return SampledLight{direction, 1, choice.emission / pdf, pdf};
}

std::optional<SampledLight> sample_environment_light(const LightTables& tables, const glm::vec2& u,
                                                     const glm::vec2& in_texel) {
  const EnvironmentSample met = sample_environment(tables.surroundings, u, in_texel);
  if (!(met.light.density > 0)) return std::nullopt;
  return SampledLight{met.towards, std::numeric_limits<float>::infinity(),
                      met.light.radiance / met.light.density, met.light.density};
}

}  // namespace

const LightChoice& choice_for(const LightTables& tables, float u) {
  const auto at = static_cast<uint>(u * static_cast<float>(LIGHT_CHOICE_RANGE));
  uint i = 0;
  while (i + 1 < tables.choice_count && tables.choices[i].end <= at) ++i;
  return tables.choices[i];
}

std::optional<SampledLight> sample_choice(const LightTables& tables, const LightChoice& choice,
                                          const vec3& origin, const glm::vec2& u, const glm::vec2& in_texel) {
  if (choice.source == LIGHT_CHOICE_ENVIRONMENT) return sample_environment_light(tables, u, in_texel);
  if ((choice.source & LIGHT_CHOICE_LISTED) != 0)
    return sample_listed(tables.lights[choice.source & ~LIGHT_CHOICE_LISTED], origin, choice.probability);
  return sample_emitter(tables, choice, origin, u);
}

}  // namespace coppice::twins
