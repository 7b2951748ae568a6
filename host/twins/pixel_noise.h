#pragma once

#include "interface/refine.h"

namespace coppice::twins {

// The square of a pixel's relative error, see noise_sum.
inline float relative_error_squared(const LuminanceSums& sums, float samples) {
  const float mean_difference = sums.sum / samples;
  const float mean = sums.first + mean_difference;
  const float squared_deviations = sums.squares - sums.sum * mean_difference;
  const float variance = squared_deviations / (samples * (samples - 1));
  const float relative = variance / (mean * mean + NOISE_DARK);
  if (!(relative > 0)) return 0;  // NaN, and what rounding has made negative
  return relative < NOISE_MOST ? relative : NOISE_MOST;
}

}  // namespace coppice::twins
