// In:  the radiance of one sample of each pixel. Out: it is added to the radiance of those before it, and its luminance
// to the sums that say how far the samples of a pixel are apart (shifted by the first one).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refine.h"
#include "lib/exact_vector.glsl"

layout(local_size_x = SAMPLE_ADD_GROUP) in;
layout(push_constant, scalar) uniform Push { SampleAddArgs args; };

LuminanceSums with(LuminanceSums before, float luminance) {
  precise float above = luminance - before.first;
  precise float sum = before.sum + above;
  precise float squares = before.squares + above * above;
  return LuminanceSums(before.first, sum, squares);
}

vec3 added(vec3 a, vec3 b) {
  precise vec3 sum = a + b;
  return sum;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.pixel_count) return;
  vec3 colour = args.sample_radiance.at[i];
  float luminance = exact_dot(vec3(0.2126, 0.7152, 0.0722), colour);
  bool is_first = args.sample_index == 0u;
  args.radiance.at[i] = is_first ? colour : added(args.radiance.at[i], colour);
  args.luminance.at[i] = is_first ? LuminanceSums(luminance, 0.0, 0.0) : with(args.luminance.at[i], luminance);
}
