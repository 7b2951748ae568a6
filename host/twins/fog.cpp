#include "twins/fog.h"

#include <bit>
#include <cmath>

#include "twins/exponential.h"
#include "twins/vectors.h"

namespace coppice::twins {

Fog fog_of(const Address<const Surrounding>& surroundings) {
  const uint side = surroundings[0].end, first = 1 + side * side + side;
  return {surroundings[first].radiance, surroundings[first + 1].radiance, surroundings[first + 2].radiance,
          std::bit_cast<float>(surroundings[first].end), std::bit_cast<float>(surroundings[first + 1].end)};
}

FogReach reach_of_fog(const Fog& fog, const Ray& ray) {
  FogReach reach{0, ray.t_max};
  for (int axis = 0; axis < 3; ++axis) {
    const float from = ray.origin[axis], along = ray.direction[axis];
    const float least = fog.box_min[axis], greatest = fog.box_max[axis];
    if (std::fabs(along) < 0x1p-100f) {
      if (from < least || from > greatest) return {0, 0};
      continue;
    }
    const float a = (least - from) / along, b = (greatest - from) / along;
    reach.enters = std::fmax(reach.enters, std::fmin(a, b));
    reach.leaves = std::fmin(reach.leaves, std::fmax(a, b));
  }
  return reach;
}

float optical_depth(const Fog& fog, const vec3& direction, const FogReach& reach) {
  if (!(reach.leaves > reach.enters)) return 0;
  return fog.density * ((reach.leaves - reach.enters) * length_of(direction));
}

float transmittance_of(const Fog& fog, const Ray& ray) {
  return exp_minus(optical_depth(fog, ray.direction, reach_of_fog(fog, ray)));
}

float phase_of(float anisotropy, float cosine) {
  const float base = 1 + anisotropy * anisotropy - 2 * anisotropy * cosine;
  return ONE_BY_4PI * (1 - anisotropy * anisotropy) / (base * std::sqrt(base));
}

}  // namespace coppice::twins
