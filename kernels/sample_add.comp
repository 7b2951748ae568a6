// In:  the radiance of one sample of each pixel. Out: it is added to the radiance of those before it, and its luminance
// to the sums that say how far the samples of a pixel are apart (shifted by the first one).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refine.h"
#include "lib/exact_vector.glsl"

layout(local_size_x = SAMPLE_ADD_GROUP) in;
layout(push_constant, scalar) uniform Push { SampleAddArgs args; };
layout(constant_id = 0) const uint SAMPLE_ADD_IS_LIST = 0u;
layout(constant_id = 1) const uint SAMPLE_ADD_HAS_COUNTS = 0u;

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
  uint pixel = i;
  if (SAMPLE_ADD_IS_LIST != 0u) pixel = args.pixels.at[i];
  args.radiance.at[pixel] = is_first ? colour : added(args.radiance.at[pixel], colour);
  args.luminance.at[pixel] =
      is_first ? LuminanceSums(luminance, 0.0, 0.0) : with(args.luminance.at[pixel], luminance);
  if (SAMPLE_ADD_HAS_COUNTS != 0u) args.sample_counts.at[pixel] = args.sample_index + 1u;
}
