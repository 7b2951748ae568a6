#include "interface/refine.h"

namespace coppice::twins {

void sample_add(const SampleAddArgs& args) {
  for (uint i = 0; i < args.pixel_count; ++i) {
    const vec3 colour = args.sample_radiance[i];
    float y = 0.2126f * colour.x;
    y += 0.7152f * colour.y;
    y += 0.0722f * colour.z;
    if (args.sample_index == 0) {
      args.radiance[i] = colour;
      args.luminance[i] = {y, 0, 0};
      continue;
    }
    args.radiance[i] += colour;
    LuminanceSums& sums = args.luminance[i];
    const float difference = y - sums.first;
    sums.sum += difference;
    sums.squares += difference * difference;
  }
}

}  // namespace coppice::twins
