#pragma once

#include "interface/environment.h"

namespace coppice::twins {

using Surroundings = Address<const Surrounding>;

struct EnvironmentLight {
  vec3 radiance;
  float density;  // by solid angle, that the environment is chosen among the lights included
};

// In a direction of any length but 0. There must be a map.
EnvironmentLight environment_in(const Surroundings& surroundings, const vec3& direction);

struct EnvironmentSample {
  vec3 towards;  // a place of the octahedron, so not of unit length
  EnvironmentLight light;
};

// `u` and `in_texel` are in [0, 1)^2; the first multiples of 2^-24.
EnvironmentSample sample_environment(const Surroundings& surroundings, const glm::vec2& u,
                                     const glm::vec2& in_texel);

}  // namespace coppice::twins
