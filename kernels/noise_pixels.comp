// In:  marks of pixels and their prefix sums. Out: the marked pixels one behind the other, and how many they are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refine.h"

layout(local_size_x = NOISE_PIXELS_GROUP) in;
layout(push_constant, scalar) uniform Push { NoisePixelsArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.pixel_count) return;
  uint mark = args.marks.at[i], place = args.places.at[i];
  if (i + 1u == args.pixel_count) args.active_count.at[0] = place + mark;
  if (mark != 0u) args.pixels.at[place] = i;
}
