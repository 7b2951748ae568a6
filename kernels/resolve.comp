// In:  radiance summed over the samples. Out: RGBA8 pixels, sRGB (IEC 61966-2-1). The code of a channel is found by
// comparing with the least linear value of each code, so it is exact on every device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/film_pixel.glsl"
#include "lib/selected.glsl"

layout(local_size_x = RESOLVE_GROUP) in;
layout(push_constant, scalar) uniform Push { ResolveArgs args; };

// A guess that is at most one off, whatever the device's pow; thresholds decide. The code of NaN is 0.
uint srgb_code(float linear) {
  float x = lesser(greater(linear, 0.0), 1.0);
  float encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
  uint code = uint(clamp(encoded * 255.0 + 0.5, 0.0, 255.0));
  if (linear < uintBitsToFloat(args.srgb_thresholds.at[code])) return code - 1u;
  if (code < 255u && linear >= uintBitsToFloat(args.srgb_thresholds.at[code + 1u])) return code + 1u;
  return code;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Film film = args.film.at[0];
  precise vec3 mean = args.radiance.at[i] / float(film.samples);
  uvec2 pixel = film_pixel(args.first_ray + i, film);
  args.image.at[pixel.y * film.width + pixel.x] =
      0xff000000u | (srgb_code(mean.z) << 16) | (srgb_code(mean.y) << 8) | srgb_code(mean.x);
}
