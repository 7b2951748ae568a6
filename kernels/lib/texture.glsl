// The colour of a texture at a place: bilinear within a level and linear between two. All in a fixed order and without
// what a device may round its own way, so the twin (host/twins/texture.h) has the same bits.
#ifndef COPPICE_LIB_TEXTURE
#define COPPICE_LIB_TEXTURE
#include "interface/texture.h"

struct TexelPair {
  uint low, high;  // within the level
  float part;      // of the way from low to high
};

// Along one axis to 0 to 1. What is not finite, or so large that float holds no parts of a texel, is 0.
float wrapped(float place, uint wrap) {
  uint size = floatBitsToUint(place) & 0x7fffffffu;
  if (size < 0x21800000u || size >= 0x4b000000u) return 0.0;  // below 2^-60, from 2^23 on or NaN
  if (wrap == TEXTURE_CLAMP) return min(max(place, 0.0), 1.0);
  if (wrap == TEXTURE_MIRROR) {
    precise float twice = place - 2.0 * floor(0.5 * place);
    return twice > 1.0 ? 2.0 - twice : twice;
  }
  precise float part = place - floor(place);
  return part;
}

// Texel i reaches from i to i + 1, and its colour is that of its middle.
TexelPair texel_pair(float place, uint size, uint wrap) {
  precise float at = place * float(size) - 0.5;
  precise float part = at - floor(at);
  int last = int(size) - 1, low = clamp(int(floor(at)), -1, last), high = low + 1;
  bool repeats = wrap == TEXTURE_REPEAT;
  return TexelPair(uint(low >= 0 ? low : repeats ? last : 0), uint(high <= last ? high : repeats ? 0 : last), part);
}

// `linear` has the linear value of each sRGB code.
vec4 texel_colour(uint texel, bool is_colour, FloatBuffer linear) {
  uvec4 code = uvec4(texel, texel >> 8, texel >> 16, texel >> 24) & 255u;
  precise vec4 parts = vec4(code) * 0.003921569;
  return is_colour ? vec4(linear.at[code.x], linear.at[code.y], linear.at[code.z], parts.w) : parts;
}

vec4 between(vec4 low, vec4 high, float part) {
  precise vec4 colour = low + (high - low) * part;
  return colour;
}

vec4 level_colour(TextureHeader header, UintBuffer texels, FloatBuffer linear, vec2 place, uint level) {
  uint first = header.first_word, width = header.width, height = header.height;
  for (uint i = 0; i < min(level, MAX_TEXTURE_LEVELS); ++i) {
    first += width * height;
    width = max(width / 2, 1u);
    height = max(height / 2, 1u);
  }
  TexelPair x = texel_pair(place.x, width, header.flags >> TEXTURE_WRAP_U_SHIFT & TEXTURE_WRAP_MASK);
  TexelPair y = texel_pair(place.y, height, header.flags >> TEXTURE_WRAP_V_SHIFT & TEXTURE_WRAP_MASK);
  bool is_colour = (header.flags & TEXTURE_COLOUR) != 0;
  uint above = first + y.low * width, below = first + y.high * width;
  vec4 upper = between(texel_colour(texels.at[above + x.low], is_colour, linear),
                       texel_colour(texels.at[above + x.high], is_colour, linear), x.part);
  vec4 lower = between(texel_colour(texels.at[below + x.low], is_colour, linear),
                       texel_colour(texels.at[below + x.high], is_colour, linear), x.part);
  return between(upper, lower, y.part);
}

const float TEXTURE_LEAST_LEVEL = 9.5367431640625e-7;  // 2^-20; below it is 0

// `level` 0 is the finest; one beyond the levels, or NaN, is the nearest of them, NaN the finest. Reads nothing outside
// of the texture, whatever `uv` is.
vec4 texture_colour(TextureHeaderBuffer headers, UintBuffer texels, FloatBuffer linear, uint which, vec2 uv,
                    float level) {
  TextureHeader header = headers.at[which];
  precise vec2 scaled = uv * header.scale + header.offset;
  vec2 place = vec2(wrapped(scaled.x, header.flags >> TEXTURE_WRAP_U_SHIFT & TEXTURE_WRAP_MASK),
                    wrapped(scaled.y, header.flags >> TEXTURE_WRAP_V_SHIFT & TEXTURE_WRAP_MASK));
  float fine = level > TEXTURE_LEAST_LEVEL ? min(level, float(header.levels - 1)) : 0.0;
  uint finer = uint(fine);
  precise float part = fine - float(finer);
  vec4 colour = level_colour(header, texels, linear, place, finer);
  if (part == 0.0) return colour;
  return between(colour, level_colour(header, texels, linear, place, finer + 1), part);
}

#endif
