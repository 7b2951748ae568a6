#include <algorithm>

#include "interface/trace.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

vec3 sky(const Ray& ray, const Lighting& lighting) {
  const float height = std::max(unit_vector(ray.direction).y, 0.0f);
  return lighting.sky_horizon + (lighting.sky_zenith - lighting.sky_horizon) * height;
}

vec3 surface(const ShadeArgs& args, const Ray& ray, uint index) {
  const vec3 normal = unit_normal(args.triangles[index]);
  const bool from_behind = dot_product(normal, ray.direction) > 0;
  const float cosine = dot_product(normal, args.lighting[0].light_direction) * (from_behind ? -1.0f : 1.0f);
  const SurfaceMaterial& material = args.materials[args.material_index[index]];
  return material.ambient + material.diffuse * std::max(cosine, 0.0f);
}

}  // namespace

void shade(const ShadeArgs& args) {
  for (uint i = 0; i < args.ray_count; ++i) {
    const uint index = args.hits[i].triangle;
    const vec3 colour =
        index == NO_TRIANGLE ? sky(args.rays[i], args.lighting[0]) : surface(args, args.rays[i], index);
    args.radiance[i] = args.sample_index == 0 ? colour : args.radiance[i] + colour;
  }
}

}  // namespace coppice::twins
