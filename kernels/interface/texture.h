// Textures: all texels in one buffer, a header each, and what triangles' corners have to lay them on.
#ifndef COPPICE_INTERFACE_TEXTURE_H
#define COPPICE_INTERFACE_TEXTURE_H
#include "types.h"
INTERFACE_BEGIN

const uint TEXTURE_NONE = 0xffffffffu;

const uint TEXTURE_REPEAT = 0;
const uint TEXTURE_CLAMP = 1;
const uint TEXTURE_MIRROR = 2;

// Bits of TextureHeader::flags.
const uint TEXTURE_WRAP_U_SHIFT = 0;
const uint TEXTURE_WRAP_V_SHIFT = 2;
const uint TEXTURE_WRAP_MASK = 3;
const uint TEXTURE_COLOUR = 16;  // r, g and b are sRGB codes; else, as alpha always, parts of 255

const uint MAX_TEXTURE_SIDE = 16384;
const uint MAX_TEXTURE_LEVELS = 15;
const uint MAX_TEXTURE_WORDS = 1u << 30;  // of all textures together

// A texel is a word, r in the lowest byte, then g, b and a. Rows go from the top down. Levels follow each
// other, the finest first, each of half the sides of the one before, rounded down, at least 1.
struct TextureHeader {
  uint first_word;     // of the finest level
  uint width, height;  // of it; from 1 to MAX_TEXTURE_SIDE
  uint levels;         // from 1 to MAX_TEXTURE_LEVELS; the last may have any size
  vec2 scale;          // texture coordinates times this, at most 2^20,
  vec2 offset;         // plus this are (0, 0) at the upper left corner and (1, 1) at the lower right one
  uint flags;
  uint padding0, padding1, padding2;
};

// What a material's maps are: textures, or TEXTURE_NONE.
struct MaterialTextures {
  uint diffuse, opacity, emission, bump, normal, roughness, metallic;
  uint channels;       // of those of single numbers, 4 bits each, see below: where r is 0 and luminance is 4
  float strength;      // of the bump or normal map
  float alpha_cutoff;  // below it in the opacity map nothing is there, else it is solid; negative: no such
                       // thing
  uint padding0, padding1;
};

const uint CHANNEL_ALPHA = 3;
const uint CHANNEL_LUMINANCE = 4;
const uint CHANNEL_MASK = 15;
const uint OPACITY_CHANNEL_SHIFT = 0;
const uint BUMP_CHANNEL_SHIFT = 4;
const uint ROUGHNESS_CHANNEL_SHIFT = 8;
const uint METALLIC_CHANNEL_SHIFT = 12;

// log2(1 + m) is m + m (1 - m) (these as a polynomial of m) to within 0.00014, for m from 0 to 1, and right
// at both ends.
const float LOG2_BEND_0 = 0.4383f, LOG2_BEND_1 = -0.2367f, LOG2_BEND_2 = 0.0795f;

// Bits of CornerAttributes::flags: whether all three corners have them.
const uint HAS_TEXCOORDS = 1;
const uint HAS_NORMALS = 2;  // of unit length, none of them zero

// What a triangle's corners have; zeros where they have none.
struct CornerAttributes {
  vec2 texcoord_a, texcoord_b, texcoord_c;
  vec3 normal_a, normal_b, normal_c;
  uint flags;
};

INTERFACE_BUFFER(TextureHeaderBuffer, TextureHeader, 16)
INTERFACE_BUFFER(MaterialTexturesBuffer, MaterialTextures, 16)
INTERFACE_BUFFER(CornerAttributesBuffer, CornerAttributes, 4)

INTERFACE_END
#endif
