#include <algorithm>
#include <bit>

#include "interface/trace.h"

namespace coppice::twins {

void resolve(const ResolveArgs& args) {
  const uint* const thresholds = &args.srgb_thresholds[0];
  const auto srgb_code = [&](float linear) {
    const auto above = std::upper_bound(thresholds + 1, thresholds + 256, linear, [](float value, uint bits) {
      return value < std::bit_cast<float>(bits);
    });
    return static_cast<uint>(above - thresholds - 1);
  };
  for (uint i = 0; i < args.pixel_count; ++i) {
    const vec3 mean = args.radiance[i] / static_cast<float>(args.samples);
    args.image[args.first_pixel + i] =
        0xff000000u | srgb_code(mean.z) << 16 | srgb_code(mean.y) << 8 | srgb_code(mean.x);
  }
}

}  // namespace coppice::twins
