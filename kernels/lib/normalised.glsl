#ifndef COPPICE_LIB_NORMALISED
#define COPPICE_LIB_NORMALISED
// Normalised coordinates: world units times a power of two that brings the scene's largest coordinate to [2^59, 2^60),
// so that no area overflows and none is denormal. See docs/numerics.md, "Normalised coordinates".
#include "lib/ordered_float.glsl"

// 2^-40: smaller coordinates count as zero. All others are multiples of 2^-63, and so are their differences: a product
// of two is zero or at least 2^-126, and no denormal ever comes up.
const float NORMALISED_FLOOR = 9.094947017729282e-13;

struct Normalisation {
  float factor_a, factor_b;  // two factors: their product may lie outside the range of a float
};

vec3 scene_box_min(BuildState state) { return from_ordered(~state.box_min_complement); }
vec3 scene_box_max(BuildState state) { return from_ordered(state.box_max); }

float power_of_two(int exponent) { return uintBitsToFloat(uint(exponent + 127) << 23); }
int biased_exponent(float x) { return int((floatBitsToUint(x) >> 23) & 0xffu); }

Normalisation normalisation_of(vec3 box_min, vec3 box_max) {
  vec3 largest = max(abs(box_min), abs(box_max));
  int exponent = 186 - biased_exponent(max(max(largest.x, largest.y), largest.z));
  int half_exponent = exponent >> 1;
  return Normalisation(power_of_two(half_exponent), power_of_two(exponent - half_exponent));
}

Normalisation scene_normalisation(BuildState state) {
  return normalisation_of(scene_box_min(state), scene_box_max(state));
}

vec3 normalised(vec3 position, Normalisation normalisation) {
  precise vec3 scaled = position * normalisation.factor_a * normalisation.factor_b;
  return mix(scaled, vec3(0.0), lessThan(abs(scaled), vec3(NORMALISED_FLOOR)));
}

#endif
