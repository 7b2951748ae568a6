// Which level of a texture a ray's footprint asks for: ray cones (Akenine-Moeller et al. 2021, "Improved Shader and
// Texture Level of Detail Using Ray Cones", equation 2, after Akenine-Moeller et al. 2019). The level is
//   log2(sqrt(texels of the triangle / area of the triangle) * width of the cone / cosine),
// as a sum of logarithms, so that nothing overflows: what belongs to the surface once a hit, the size of the texture
// once a texture. The cone's spread does not change where surfaces curve. Include lib/exact_vector.glsl before.
#ifndef COPPICE_LIB_TEXTURE_LEVEL
#define COPPICE_LIB_TEXTURE_LEVEL
#include "interface/texture.h"

// Of positive numbers: the exponent, and a polynomial of the mantissa that is right at both its ends; at most 0.00014 off.
// -126 for what is not positive, denormal or NaN, 128 for infinity.
float log2_by_bits(float x) {
  uint bits = floatBitsToUint(x);
  if (bits < 0x00800000u || bits > 0x7f800000u) return -126.0;
  precise float m = uintBitsToFloat((bits & 0x007fffffu) | 0x3f800000u) - 1.0;
  precise float bend = m * (1.0 - m) * (LOG2_BEND_0 + m * (LOG2_BEND_1 + m * LOG2_BEND_2));
  precise float result = float(int(bits >> 23) - 127) + (m + bend);
  return result;
}

// Without what is so small that a product of two could be denormal.
float without_small(float x) { return (floatBitsToUint(x) & 0x7fffffffu) < 0x21800000u ? 0.0 : x; }

bool is_number(float x) { return (floatBitsToUint(x) & 0x7fffffffu) < 0x7f800000u; }
float infinite_or(float x) { return is_number(x) ? x : uintBitsToFloat(0x7f800000u); }

// Twice the area that a triangle takes of the plane of texture coordinates.
float twice_texcoord_area(CornerAttributes corners) {
  precise vec2 b = corners.texcoord_b - corners.texcoord_a, c = corners.texcoord_c - corners.texcoord_a;
  b = vec2(without_small(b.x), without_small(b.y));
  c = vec2(without_small(c.x), without_small(c.y));
  precise float area = b.x * c.y - b.y * c.x;
  return infinite_or(abs(area));
}

// Twice the area of a triangle; 0 below 2^-100. Infinity, as of texture coordinates, where it is no number.
float twice_area(Triangle triangle) {
  precise vec3 b = triangle.b - triangle.a, c = triangle.c - triangle.a;
  b = vec3(without_small(b.x), without_small(b.y), without_small(b.z));
  c = vec3(without_small(c.x), without_small(c.y), without_small(c.z));
  vec3 across = exact_cross(b, c), size = abs(across);
  if (!is_number(across.x) || !is_number(across.y) || !is_number(across.z)) return uintBitsToFloat(0x7f800000u);
  float largest = max(max(size.x, size.y), size.z);
  if (!(largest >= 7.888609e-31)) return 0.0;
  precise vec3 scaled = across / largest;
  precise float area = sqrt(exact_dot(scaled, scaled)) * largest;
  return area;
}

// Of a cone along its axis.
float cone_width_at(float width, float spread, float distance) {
  precise float result = width + spread * distance;
  return result;
}

// The surface's part of the level: with this cone, and this cosine between its axis and the normal, positive.
float surface_level(float twice_texcoords, float twice_area, float cone_width, float cosine) {
  precise float level = 0.5 * (log2_by_bits(twice_texcoords) - log2_by_bits(twice_area)) +
                        (log2_by_bits(cone_width) - log2_by_bits(cosine));
  return level;
}

// The texture's part.
float texture_level(TextureHeader header) {
  precise float texels = float(header.width) * float(header.height) * abs(header.scale.x * header.scale.y);
  precise float level = 0.5 * log2_by_bits(texels);
  return level;
}

#endif
