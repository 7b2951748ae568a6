#include <algorithm>

#include "interface/refine.h"

namespace coppice::twins {

namespace {

float relative_error_squared(const LuminanceSums& sums, float samples) {
  const float mean_difference = sums.sum / samples;
  const float mean = sums.first + mean_difference;
  const float squared_deviations = sums.squares - sums.sum * mean_difference;
  const float variance = squared_deviations / (samples * (samples - 1));
  const float relative = variance / (mean * mean + NOISE_DARK);
  if (!(relative > 0)) return 0;  // NaN, and what rounding has made negative
  return relative < NOISE_MOST ? relative : NOISE_MOST;
}

}  // namespace

void noise_sum(const NoiseSumArgs& args) {
  for (uint first = 0; first < args.count; first += NOISE_SUM_RUN) {
    float sum = 0;
    for (uint i = first; i < std::min(first + NOISE_SUM_RUN, args.count); ++i)
      sum += args.luminance.value
                 ? relative_error_squared(args.luminance[i], static_cast<float>(args.samples))
                 : args.values[i];
    args.sums[first / NOISE_SUM_RUN] = sum;
  }
}

}  // namespace coppice::twins
