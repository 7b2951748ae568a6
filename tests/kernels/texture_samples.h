// A stage of the tests alone: all that kernels/lib/texture.glsl and texture_level.glsl have.
#ifndef COPPICE_TESTS_TEXTURE_SAMPLES_H
#define COPPICE_TESTS_TEXTURE_SAMPLES_H
#include "interface/texture.h"
INTERFACE_BEGIN

const uint TEXTURE_SAMPLE_WORDS = 6;  // which texture (bits); u, v, level; width of the cone, cosine
const uint TEXTURE_RESULT_WORDS = 8;  // r, g, b, a; the surface's level, the texture's, both areas

struct TextureSamplesArgs {
  READS(TextureHeaderBuffer) headers;
  READS(UintBuffer) texels;
  READS(FloatBuffer) linear;
  READS(CornerAttributesBuffer) corners;  // one a sample
  READS(TriangleBuffer) triangles;        // one a sample
  READS(FloatBuffer) samples;
  FloatBuffer results;
  uint sample_count;
  uint padding;
};

INTERFACE_END
#endif
