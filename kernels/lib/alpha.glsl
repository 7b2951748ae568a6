// Where triangles let a ray through (interface/alpha.h). Kernels that include it, behind their `args`, define what the
// walks look for, TRACE_ALPHA: without it nothing of this is compiled. All is exact, so the twin (host/twins/alpha.h)
// decides alike on every device.
#ifndef COPPICE_LIB_ALPHA
#define COPPICE_LIB_ALPHA
#define TRACE_ALPHA
#include "random.glsl"
#include "texture.glsl"

// A hash of the ray as given: its words, one after the other, each mixed into that of those before (random.glsl).
uint alpha_key(Ray ray) {
  uvec3 origin = floatBitsToUint(ray.origin), direction = floatBitsToUint(ray.direction);
  uint words[6] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z};
  uint key = 0u;
  [[unroll]] for (uint k = 0u; k < 6u; ++k) {
    uint state = key ^ words[k];
    key = next_random(state);
  }
  return key;
}

// In [0, 1), a multiple of 2^-24.
float alpha_random(uint key, uint triangle) {
  uint state = key ^ triangle;
  return float(next_random(state) >> 8) * 5.9604644775390625e-8;
}

float alpha_texel(uint i) { return float(args.alpha_texels.at[i >> 2] >> ((i & 3u) << 3) & 255u); }

float between(float low, float high, float part) {
  precise float result = low + (high - low) * part;
  return result;
}

// From 0 to 255.
float alpha_at(AlphaMap map, vec2 uv) {
  precise vec2 place = uv * map.scale + map.offset;
  uint wrap_u = map.flags >> TEXTURE_WRAP_U_SHIFT & TEXTURE_WRAP_MASK;
  uint wrap_v = map.flags >> TEXTURE_WRAP_V_SHIFT & TEXTURE_WRAP_MASK;
  TexelPair x = texel_pair(wrapped(place.x, wrap_u), map.width, wrap_u);
  TexelPair y = texel_pair(wrapped(place.y, wrap_v), map.height, wrap_v);
  uint above = map.first_texel + y.low * map.width, below = map.first_texel + y.high * map.width;
  float upper = between(alpha_texel(above + x.low), alpha_texel(above + x.high), x.part);
  float lower = between(alpha_texel(below + x.low), alpha_texel(below + x.high), x.part);
  return between(upper, lower, y.part);
}

bool is_hole(Hit hit, uint map_index, uint key) {
  AlphaTriangle triangle = args.alpha_triangles.at[hit.triangle];
  AlphaMap map = args.alpha_maps.at[map_index];
  precise float w = 1.0 - hit.u - hit.v;
  precise vec2 uv = triangle.texcoord_a * w + triangle.texcoord_b * hit.u + triangle.texcoord_c * hit.v;
  float alpha = alpha_at(map, uv);
  if (map.is_coverage == 0u) return !(alpha >= map.threshold);
  precise float least = alpha_random(key, hit.triangle) * map.threshold;
  return !(alpha > least);
}

// Whether the ray with this key passes the triangle that it hits. Of one that is solid its word is all that is read.
bool lets_through(Hit hit, uint key) {
  uint map = args.alpha_triangles.at[hit.triangle].map;
  if (map == ALPHA_SOLID) return false;
  return map == ALPHA_NOTHING || is_hole(hit, map, key);
}

#endif
