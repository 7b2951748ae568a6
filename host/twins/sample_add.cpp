#include "interface/refine.h"

namespace coppice::twins {

void sample_add(const SampleAddArgs& args) {
  for (uint i = 0; i < args.pixel_count; ++i) {
    const vec3 colour = args.sample_radiance[i];
    float y = 0.2126f * colour.x;
    y += 0.7152f * colour.y;
    y += 0.0722f * colour.z;
    const uint pixel = args.pixels.value ? args.pixels[i] : i;
    if (args.sample_counts.value) args.sample_counts[pixel] = args.sample_index + 1;
    if (args.sample_index == 0) {
      args.radiance[pixel] = colour;
      args.luminance[pixel] = {y, 0, 0};
      continue;
    }
    args.radiance[pixel] += colour;
    LuminanceSums& sums = args.luminance[pixel];
    const float difference = y - sums.first;
    sums.sum += difference;
    sums.squares += difference * difference;
  }
}

}  // namespace coppice::twins
