#include <algorithm>

#include "interface/refine.h"
#include "twins/pixel_noise.h"

namespace coppice::twins {

void noise_sum(const NoiseSumArgs& args) {
  for (uint first = 0; first < args.count; first += NOISE_SUM_RUN) {
    float sum = 0;
    for (uint i = first; i < std::min(first + NOISE_SUM_RUN, args.count); ++i) {
      if (!args.luminance.value) {
        sum += args.values[i];
        continue;
      }
      const uint samples = args.sample_counts.value ? args.sample_counts[i] : args.samples;
      sum += relative_error_squared(args.luminance[i], static_cast<float>(samples));
    }
    args.sums[first / NOISE_SUM_RUN] = sum;
  }
}

}  // namespace coppice::twins
