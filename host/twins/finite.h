#pragma once

#include <cmath>

#include "interface/types.h"

namespace coppice::twins {

inline bool all_finite(const vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// +0 for -0 and denormals.
inline float flushed(float x) { return std::isnormal(x) || !std::isfinite(x) ? x : 0.0f; }

}  // namespace coppice::twins
