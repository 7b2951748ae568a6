#pragma once

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>

#include "interface/wide.h"
#include "twins/trace_ray.h"

namespace coppice::twins {

// The distances of one ray to the planes of wide nodes: t in units that bring the scene below the range, plus
// an offset, so that those that matter are positive.
class WideDistances {
 public:
  WideDistances(const TraceRay& ray, const vec3& box_min, const vec3& box_max) : origin_(ray.origin) {
    float reach[3];
    for (int axis = 0; axis < 3; ++axis)
      reach[axis] =
          std::max(std::fabs(box_min[axis] - ray.origin[axis]), std::fabs(box_max[axis] - ray.origin[axis]));
    const float farthest = std::max({reach[0], reach[1], reach[2]});
    const float far_end = std::max(reach[ray.axis] * 1.25f * std::fabs(ray.stretch), farthest * flattest);
    const int exponent = far_end < FLT_MIN ? -30 : std::clamp(std::ilogb(far_end) + 1, -30, 125);
    unit_ = std::ldexp(1.0f, 33 - exponent);
    offset_ = ray.t_min < 0 ? 3 * range : 0;
    const bool meets_all = !(farthest < farthest_reach);
    first = meets_all ? least : std::max(std::clamp(ray.t_min * unit_, -range, range) + offset_, least);
    for (int axis = 0; axis < 3; ++axis) {
      inverse_[axis] = unit_ * (std::isinf(ray.inverse[axis]) ? std::copysign(most_inverse, ray.inverse[axis])
                                                              : ray.inverse[axis]);
      const float size = std::fabs(inverse_[axis]);
      const float room = std::fabs(origin_[axis]) * room_by_origin * size + offset_ * room_by_offset;
      pad_[axis] = (meets_all ? 0x1p126f : room) - offset_;
      if (meets_all) inverse_[axis] = 0;
    }
  }

  // How far a hit at t is.
  float of_hit(float t) const {
    return std::max(std::clamp(t * unit_, -range, range * share_of_range) + offset_, least);
  }

  // Where the ray enters a child's box; false if it misses it up to `limit`.
  bool meet(const WideNode& node, uint child, float limit, float& enter) const {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(node.planes) + 6 * child;
    float cell[3], away = 0;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = std::bit_cast<float>((node.exponents >> (8 * axis) & 0xff) << 23);
      away = std::max(away, std::fabs(node.origin[axis] - origin_[axis]));
    }
    const float reach = away + std::max({cell[0], cell[1], cell[2]}) * WIDE_NODE_STEPS;
    enter = first;
    float leave = limit;
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = cell[axis] * inverse_[axis];
      const float start = (node.origin[axis] - origin_[axis]) * inverse_[axis];
      const float pad = std::fabs(inverse_[axis]) * (reach * room_by_reach) + pad_[axis];
      const bool backward = inverse_[axis] < 0;
      const std::uint8_t near = bytes[backward ? axis + 3 : axis], far = bytes[backward ? axis : axis + 3];
      enter = std::max(enter, near * scale + (start - pad));
      leave = std::min(leave, far * scale + (start + (pad + 2 * (offset_ + least))));
    }
    return enter <= leave;
  }

  // The distance as far as a list of children keeps it, in 13 bits: eight of the mantissa, and the binade.
  static uint kept_bits(float distance) { return std::bit_cast<uint>(distance) >> 15 & 0x1fff; }

  float first;

 private:
  static constexpr float range = 0x1p33f, share_of_range = 1 - 0x1p-8f, least = 2;
  static constexpr float room_by_reach = 0x1p-19f, room_by_origin = 0x1p-23f, room_by_offset = 0x1p-18f;
  static constexpr float flattest = 0x1p-16f;
  static constexpr float farthest_reach = 0x1p60f;
  static constexpr float most_inverse = 0x1p64f;

  vec3 origin_;
  float inverse_[3], pad_[3], unit_, offset_;
};

}  // namespace coppice::twins
