// In: samples. Out: what the libraries of textures make of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "texture_samples.h"
#include "lib/exact_vector.glsl"
#include "lib/texture.glsl"
#include "lib/texture_level.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { TextureSamplesArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.sample_count) return;
  uint from = i * TEXTURE_SAMPLE_WORDS, to = i * TEXTURE_RESULT_WORDS;
  uint which = floatBitsToUint(args.samples.at[from]);
  vec2 uv = vec2(args.samples.at[from + 1], args.samples.at[from + 2]);
  vec4 colour = texture_colour(args.headers, args.texels, args.linear, which, uv, args.samples.at[from + 3]);
  for (uint channel = 0; channel < 4; ++channel) args.results.at[to + channel] = colour[channel];
  float texcoords = twice_texcoord_area(args.corners.at[i]), area = twice_area(args.triangles.at[i]);
  float width = cone_width_at(args.samples.at[from + 4], 0.01, 3.0);
  args.results.at[to + 4] = surface_level(texcoords, area, width, args.samples.at[from + 5]);
  args.results.at[to + 5] = texture_level(args.headers.at[which]);
  args.results.at[to + 6] = texcoords;
  args.results.at[to + 7] = area;
}
