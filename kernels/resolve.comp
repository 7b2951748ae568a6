// In:  radiance summed over the samples. Out: RGBA8 pixels, sRGB.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/film_pixel.glsl"
#include "lib/srgb_code.glsl"

layout(local_size_x = RESOLVE_GROUP) in;
layout(push_constant, scalar) uniform Push { ResolveArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Film film = args.film.at[0];
  precise vec3 mean = args.radiance.at[i] / float(film.samples);
  uvec2 pixel = film_pixel(args.first_ray + i, film);
  args.image.at[pixel.y * film.width + pixel.x] = rgba8(mean, args.srgb_thresholds);
}
