#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/common.hpp>
#include <limits>

#include "builders/lanes.h"
#include "interface/types.h"

namespace coppice {

// Three lanes hold an axis each, the fourth one is idle.
inline constexpr std::size_t AXES = 3;

// The box of a node with an axis in each lane.
struct LaneBox {
  Floats low, high;
};

inline constexpr LaneBox EMPTY_LANE_BOX = {Floats{} + std::numeric_limits<float>::infinity(),
                                           Floats{} - std::numeric_limits<float>::infinity()};

inline LaneBox lane_box(const Node& node) {
  // The idle lanes hold integers, whose bits may be those of denormals and slow: they are cleared.
  constexpr Integers axes = {-1, -1, -1, 0};
  Integers low, high;
  std::memcpy(&low, &node.box_min, sizeof(low));
  std::memcpy(&high, &node.box_max, sizeof(high));
  return {std::bit_cast<Floats>(low & axes), std::bit_cast<Floats>(high & axes)};
}

inline LaneBox lane_union(const LaneBox& a, const LaneBox& b) {
  return {smaller(a.low, b.low), larger(a.high, b.high)};
}

// Twice the centre of a box, in units in which neither it nor any area times a count of triangles overflows.
inline Floats scaled_centre(const LaneBox& box, float scale) { return box.low * scale + box.high * scale; }

// The power of two to scale a scene by: its largest coordinate comes to 2^40 or below.
inline float centre_scale(const Aabb& scene) {
  const vec3 magnitude = glm::max(glm::abs(scene.box_min), glm::abs(scene.box_max));
  const float largest = std::max({magnitude.x, magnitude.y, magnitude.z});
  if (largest == 0.0f) return 1.0f;
  return std::ldexp(1.0f, std::min(39 - std::ilogb(largest), 100));
}

// Half the area of a box that is not empty, in these units.
inline float half_area(const LaneBox& box, float scale) {
  const Floats extent = box.high * scale - box.low * scale;
  return (extent[0] * extent[1] + extent[1] * extent[2]) + extent[2] * extent[0];
}

}  // namespace coppice
