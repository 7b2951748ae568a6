// The square of a pixel's relative error, see noise_sum.
#ifndef COPPICE_LIB_PIXEL_NOISE
#define COPPICE_LIB_PIXEL_NOISE
#include "lib/selected.glsl"

float pixel_noise(LuminanceSums sums, float samples) {
  precise float above = sums.sum / samples;
  precise float mean = sums.first + above;
  precise float apart = sums.squares - sums.sum * above;
  precise float variance_of_mean = apart / (samples * (samples - 1.0));
  precise float relative = variance_of_mean / (mean * mean + NOISE_DARK);
  return lesser(greater(relative, 0.0), NOISE_MOST);
}

#endif
