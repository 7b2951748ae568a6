// Triangles read as words of 64 bits, for devices that load lane by lane: five in place of nine. An odd triangle of 36
// bytes begins in the middle of a word; an even one reads the first four bytes behind it, which belong to the next one
// or to what follows every slot.
#ifndef COPPICE_LIB_TRIANGLE_WORDS
#define COPPICE_LIB_TRIANGLE_WORDS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer TriangleWordsBuffer { uint64_t at[]; };

const uint TRIANGLE_WORDS = 9u;

Triangle load_triangle(TriangleBuffer triangles, uint triangle) {
  TriangleWordsBuffer words = TriangleWordsBuffer(triangles);
  uint first = triangle * TRIANGLE_WORDS;
  bool odd = (first & 1u) != 0u;
  uvec2 pairs[5];
  [[unroll]] for (uint k = 0u; k < 5u; ++k) pairs[k] = unpackUint2x32(words.at[first / 2u + k]);
  float x[TRIANGLE_WORDS];
  [[unroll]] for (uint k = 0u; k < TRIANGLE_WORDS; ++k)
    x[k] = uintBitsToFloat(odd ? pairs[(k + 1u) / 2u][(k + 1u) & 1u] : pairs[k / 2u][k & 1u]);
  return Triangle(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]), vec3(x[6], x[7], x[8]));
}

#endif
