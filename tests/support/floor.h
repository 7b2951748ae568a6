#pragma once

#include <limits>

#include "interface/trace.h"

namespace coppice {

inline constexpr float INFINITE = std::numeric_limits<float>::infinity();
inline constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

inline constexpr Hit MISS{INFINITE, NO_TRIANGLE, 0, 0};

// A triangle in the plane z = 0.
inline const Triangle FLOOR{vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};

inline Ray ray_from(const vec3& origin, const vec3& direction) { return {origin, 0.0f, direction, INFINITE}; }

// Straight down on the floor, from z = `height`.
inline Ray down_at(float x, float y, float height = 1) {
  return ray_from(vec3(x, y, height), vec3(0, 0, -1));
}

}  // namespace coppice
