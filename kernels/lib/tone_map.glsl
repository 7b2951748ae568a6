// What a display is to show of linear radiance, still linear: docs/effects.md#tone-mapping. Of sums, products and
// quotients alone. NaN and what is below 0 count as 0, what is above TONE_MOST as TONE_MOST.
#ifndef COPPICE_LIB_TONE_MAP
#define COPPICE_LIB_TONE_MAP
#include "lib/exact_vector.glsl"
#include "lib/selected.glsl"

// Reinhard, Stark, Shirley, Ferwerda 2002, equation 4, on luminance: the channels keep their ratios.
vec3 tone_reinhard(vec3 colour) {
  float luminance = exact_dot(vec3(0.2126, 0.7152, 0.0722), colour);
  precise float scale = (1.0 + luminance / (TONE_WHITE * TONE_WHITE)) / (1.0 + luminance);
  precise vec3 mapped = colour * scale;
  return mapped;
}

// Hill's fit of the reference and sRGB output transforms of ACES.
vec3 tone_aces(vec3 colour) {
  vec3 v = vec3(exact_dot(vec3(0.59719, 0.35458, 0.04823), colour), exact_dot(vec3(0.07600, 0.90834, 0.01566), colour),
                exact_dot(vec3(0.02840, 0.13383, 0.83777), colour));
  precise vec3 over = v * (v + 0.0245786) - 0.000090537;
  precise vec3 under = v * (0.983729 * v + 0.4329510) + 0.238081;
  precise vec3 fitted = over / under;
  return vec3(exact_dot(vec3(1.60475, -0.53108, -0.07367), fitted),
              exact_dot(vec3(-0.10208, 1.10813, -0.00605), fitted),
              exact_dot(vec3(-0.00327, -0.07276, 1.07602), fitted));
}

vec3 tone_mapped(vec3 radiance, uint curve) {
  vec3 colour = lesser(greater(radiance, vec3(0.0)), vec3(TONE_MOST));
  return curve == TONE_REINHARD ? tone_reinhard(colour) : tone_aces(colour);
}

#endif
