#include "interface/refine.h"

namespace coppice::twins {

void noise_pixels(const NoisePixelsArgs& args) {
  uint count = 0;
  for (uint i = 0; i < args.pixel_count; ++i) {
    if (args.marks[i] != 0) args.pixels[count++] = i;
  }
  if (args.pixel_count > 0) args.active_count[0] = count;
}

}  // namespace coppice::twins
