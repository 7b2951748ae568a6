#include <bit>

#include "twins/pixel_noise.h"

namespace coppice::twins {

void noise_marks(const NoiseMarksArgs& args) {
  const float least = std::bit_cast<float>(args.least);
  for (uint i = 0; i < args.pixel_count; ++i) {
    const auto samples = static_cast<float>(args.sample_counts[i]);
    args.marks[i] = relative_error_squared(args.luminance[i], samples) > least;
  }
}

}  // namespace coppice::twins
