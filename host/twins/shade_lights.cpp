#include <cmath>

#include "twins/leave_surface.h"
#include "twins/light_source.h"
#include "twins/material_of.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

vec3 reflected_light(const vec3& diffuse, const LightSource& light, const vec3& point, const vec3& normal) {
  const vec3 colour = diffuse * light.radiance;
  const vec3 to_light = light_direction(light, point);
  if (light.kind != LIGHT_POINT) return colour * std::fmax(dot_product(normal, to_light), 0.0f);
  const float distance = length_of(to_light);
  if (distance == 0) return vec3(0);
  const float cosine = std::fmax(dot_product(normal, unit_vector(to_light)), 0.0f);
  const float nearness = light.distance / distance;
  return colour * (cosine * (nearness * nearness));
}

}  // namespace

void shade_lights(const ShadeLightsArgs& args) {
  for (uint i = 0; i < args.ray_count; ++i) {
    const Hit hit = args.hits[i];
    if (hit.triangle == NO_TRIANGLE) continue;
    if (args.marks.value != 0 && (args.marks[i] == 0 || args.any_hits[args.places[i]] != 0)) continue;
    const Triangle& triangle = args.triangles[hit.triangle];
    vec3 normal = unit_normal(triangle);
    if (dot_product(normal, args.rays[i].direction) > 0) normal = -normal;
    const vec3& diffuse = material_of(args, i, hit.triangle).diffuse;
    for (uint light = args.first_light; light < args.first_light + args.light_count; ++light)
      args.radiance[i] += reflected_light(diffuse, args.lights[light], hit_point(triangle, hit), normal);
  }
}

}  // namespace coppice::twins
