// In:  sums of luminance. Out: 1 for each pixel whose relative error is larger than is asked for, else 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refine.h"
#include "lib/pixel_noise.glsl"

layout(local_size_x = NOISE_MARKS_GROUP) in;
layout(push_constant, scalar) uniform Push { NoiseMarksArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.pixel_count) return;
  float noise = pixel_noise(args.luminance.at[i], float(args.sample_counts.at[i]));
  args.marks.at[i] = noise > uintBitsToFloat(args.least) ? 1u : 0u;
}
