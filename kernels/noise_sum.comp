// In:  sums of luminance, or sums of runs of pixels. Out: of each run of NOISE_SUM_RUN pixels, or sums, the sum, in
// their order. Of a pixel it is the square of its relative error: the variance of its mean, which is the variance of
// its samples over their number, over the square of the mean and NOISE_DARK. What is no number is none, and no pixel
// has more than NOISE_MOST.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refine.h"
#include "lib/pixel_noise.glsl"

layout(local_size_x = NOISE_SUM_GROUP) in;
layout(push_constant, scalar) uniform Push { NoiseSumArgs args; };
layout(constant_id = 0) const uint NOISE_OF_PIXELS = 1u;  // 0 where there is no luminance
layout(constant_id = 1) const uint NOISE_HAS_COUNTS = 0u;

float value(uint i) {
  if (NOISE_OF_PIXELS == 0u) return args.values.at[i];
  uint samples = args.samples;
  if (NOISE_HAS_COUNTS != 0u) samples = args.sample_counts.at[i];
  return pixel_noise(args.luminance.at[i], float(samples));
}

float plus(float a, float b) {
  precise float sum = a + b;
  return sum;
}

void main() {
  uint run = gl_GlobalInvocationID.x, first = run * NOISE_SUM_RUN;
  if (first >= args.count) return;
  float sum = 0.0;
  uint end = min(first + NOISE_SUM_RUN, args.count);
  [[dont_unroll]] for (uint i = first; i < end; ++i) sum = plus(sum, value(i));
  args.sums.at[run] = sum;
}
