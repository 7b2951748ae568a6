// The 8-bit sRGB code of a channel (IEC 61966-2-1), found by comparing with the least linear value of each code: exact on
// every device.
#include "lib/selected.glsl"

// The guess is right or one too small: the square roots, fitted to 255 times the curve and cheaper than its pow, are off
// by less than 0.1 codes, and 0.3 + 0.1 is less than the half that rounds up. The threshold of the code above decides.
// The code of NaN is 0.
uint srgb_code(float linear, UintBuffer thresholds) {
  float x = lesser(greater(linear, 0.0), 1.0);
  float root = sqrt(x);
  float curve = 212.6081 * root + 76.0163 * sqrt(root) - 14.1058 * x - 19.6101;
  uint code = uint(clamp((x <= 0.0031308 ? 3294.6 * x : curve) + 0.3, 0.0, 255.0));
  uint above = min(code + 1u, 255u);
  return linear >= uintBitsToFloat(thresholds.at[above]) ? above : code;
}

uint rgba8(vec3 colour, UintBuffer thresholds) {
  return 0xff000000u | (srgb_code(colour.z, thresholds) << 16) | (srgb_code(colour.y, thresholds) << 8) |
         srgb_code(colour.x, thresholds);
}
