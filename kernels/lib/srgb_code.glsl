// The 8-bit sRGB code of a channel (IEC 61966-2-1), found by comparing with the least linear value of each code: exact on
// every device.
#include "lib/selected.glsl"

// The guess is right or one too small, whatever the device's pow (it is off by less than 0.02 codes); the threshold of
// the code above decides. The code of NaN is 0.
uint srgb_code(float linear, UintBuffer thresholds) {
  float x = lesser(greater(linear, 0.0), 1.0);
  float encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
  uint code = uint(clamp(encoded * 255.0 + 0.48, 0.0, 255.0));
  uint above = min(code + 1u, 255u);
  return linear >= uintBitsToFloat(thresholds.at[above]) ? above : code;
}

uint rgba8(vec3 colour, UintBuffer thresholds) {
  return 0xff000000u | (srgb_code(colour.z, thresholds) << 16) | (srgb_code(colour.y, thresholds) << 8) |
         srgb_code(colour.x, thresholds);
}
