#include "render/stage_values.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace coppice {

vec3 flush_to_zero(vec3 v) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::fpclassify(v[axis]) == FP_SUBNORMAL || v[axis] == 0) v[axis] = 0;
  }
  return v;
}

LightSource light_source(const Light& light) {
  constexpr float farthest = 0x1p100f;
  return {glm::clamp(light.place, -farthest, farthest), light.is_point ? LIGHT_POINT : LIGHT_DIRECTIONAL,
          flush_to_zero(light.radiance), std::min(light.distance, farthest)};
}

}  // namespace coppice
