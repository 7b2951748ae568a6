#include "builders/normalised_space.h"

#include <cmath>
#include <glm/common.hpp>

namespace coppice {

NormalisedSpace::NormalisedSpace(const Aabb& scene) {
  const vec3 magnitude = glm::max(glm::abs(scene.box_min), glm::abs(scene.box_max));
  const float largest = glm::max(glm::max(magnitude.x, magnitude.y), magnitude.z);
  if (largest == 0.0f) return;
  const int exponent = 59 - std::ilogb(largest);
  factor_ = std::ldexp(1.0f, exponent / 2);
  other_factor_ = std::ldexp(1.0f, exponent - exponent / 2);
}

}  // namespace coppice
