// In:  radiance summed over the samples. Out: RGBA8 pixels, sRGB; exposed and tone mapped before, if that is asked for.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/shade.h"
#include "lib/film_pixel.glsl"
#include "lib/srgb_code.glsl"
#include "lib/tone_map.glsl"

layout(local_size_x = RESOLVE_GROUP) in;
layout(push_constant, scalar) uniform Push { ResolveArgs args; };
layout(constant_id = 0) const uint RESOLVE_HAS_COUNTS = 0u;
layout(constant_id = 1) const uint RESOLVE_TONE_CURVE = 0u;  // TONE_
layout(constant_id = 2) const uint RESOLVE_EXPOSED = 0u;     // 0 where the exposure is 1

vec3 exposed(vec3 radiance) {
  precise vec3 product = radiance * uintBitsToFloat(args.exposure);
  return product;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Film film = args.film.at[0];
  uint samples = film.samples;
  if (RESOLVE_HAS_COUNTS != 0u) samples = args.sample_counts.at[i];
  precise vec3 mean = args.radiance.at[i] / float(samples);
  vec3 colour = mean;
  if (RESOLVE_EXPOSED != 0u) colour = exposed(colour);
  if (RESOLVE_TONE_CURVE != TONE_NONE) colour = tone_mapped(colour, RESOLVE_TONE_CURVE);
  uvec2 pixel = film_pixel(args.first_ray + i, film);
  args.image.at[pixel.y * film.width + pixel.x] = rgba8(colour, args.srgb_thresholds);
}
