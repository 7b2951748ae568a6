#pragma once

#include <algorithm>
#include <cmath>

#include "interface/texture.h"

namespace coppice::twins {

// A place along one axis of a texture, brought to 0 to 1 by the wrap mode. What is below 2^-60, from 2^23 on,
// or no number, is 0.
inline float unit_place(float place, uint wrap) {
  const float size = std::fabs(place);
  if (!(size >= 0x1p-60f) || !(size < 0x1p23f)) return 0;
  switch (wrap) {
    case TEXTURE_CLAMP:
      return std::clamp(place, 0.0f, 1.0f);
    case TEXTURE_MIRROR: {
      const float periods = std::floor(place / 2);
      const float in_period = place - 2 * periods;
      return in_period <= 1 ? in_period : 2 - in_period;
    }
    default:
      return place - std::floor(place);
  }
}

// A texel's number along an axis, whatever it is.
inline uint on_axis(long texel, uint side, uint wrap) {
  const long count = side;
  if (wrap == TEXTURE_REPEAT) return static_cast<uint>(((texel % count) + count) % count);
  return static_cast<uint>(std::clamp(texel, 0L, count - 1));
}

}  // namespace coppice::twins
