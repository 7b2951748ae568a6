#include "twins/shading.h"

#include <algorithm>
#include <bit>

#include "twins/vectors.h"

namespace coppice::twins {

vec3 sky_colour(const vec3& direction, const Lighting& lighting) {
  const float height = std::max(unit_vector(direction).y, 0.0f);
  return lighting.sky_horizon + (lighting.sky_zenith - lighting.sky_horizon) * height;
}

vec3 surface_colour(const SurfaceMaterial& material, const Triangle& triangle, const vec3& direction,
                    const Lighting& lighting) {
  const vec3 normal = unit_normal(triangle);
  const bool from_behind = dot_product(normal, direction) > 0;
  const float cosine = dot_product(normal, lighting.light_direction) * (from_behind ? -1.0f : 1.0f);
  return material.ambient + material.diffuse * std::max(cosine, 0.0f);
}

vec3 film_direction(const Film& film, float x, float y) {
  return film.corner + film.right * x + film.down * y;
}

uint pixel_of(const vec3& colour, READS(UintBuffer) srgb_thresholds) {
  const uint* const thresholds = &srgb_thresholds[0];
  const auto code_of = [&](float linear) {
    const auto above = std::upper_bound(thresholds + 1, thresholds + 256, linear, [](float value, uint bits) {
      return !(value >= std::bit_cast<float>(bits));
    });
    return static_cast<uint>(above - thresholds - 1);
  };
  return 0xff000000u | code_of(colour.z) << 16 | code_of(colour.y) << 8 | code_of(colour.x);
}

}  // namespace coppice::twins
