// In:  the film and hits of one ray a pixel. Out: RGBA8 pixels, the same bits as shade and resolve make of one sample, in
// one go: the ray's direction is made once more, and no radiance is kept.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/shade.h"
#include "lib/camera_ray.glsl"
#include "lib/film_pixel.glsl"
#include "lib/ray_words.glsl"
#include "lib/subgroup_run.glsl"

layout(local_size_x = SHADE_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadePixelsArgs args; };
layout(constant_id = 0) const uint SHADE_DIRECTIONAL_LIGHT = 1u;  // 0 where the scene has none

#include "lib/plain_pixel.glsl"

void main() {
  Film film = args.film.at[0];
  Lighting lighting = args.lighting.at[0];
  Run run = subgroup_run(gl_WorkGroupID.x * SHADE_PIXELS_TILE, SHADE_PIXELS_PER_INVOCATION, args.ray_count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    uvec2 pixel = film_pixel(args.first_ray + i, film);
    vec3 direction = camera_direction(vec2(pixel) + 0.5, film);
    args.image.at[pixel.y * film.width + pixel.x] = plain_pixel(args.hits.at[i].triangle, direction, lighting);
  }
}
