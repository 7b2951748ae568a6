// In:  the film. Out: one ray a pixel, and no hit yet. Directions are not normalised: t counts in units of them.
// Samples of a pixel follow a Hammersley set, a single one is the pixel's centre. Or, where it is not known how many
// there will be, the (0,2)-sequence of van der Corput and Sobol (Kollig, Keller 2002), shifted so that it begins there.
// With a lens each sample goes through a point of it, of a sequence of its own: Cook, Porter, Carpenter 1984,
// "Distributed Ray Tracing".
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/camera_ray.glsl"
#include "lib/disk_point.glsl"
#include "lib/film_pixel.glsl"
#include "lib/ray_words.glsl"
#include "lib/sampler.glsl"

layout(local_size_x = CAMERA_RAYS_GROUP) in;
layout(push_constant, scalar) uniform Push { CameraRaysArgs args; };
layout(constant_id = 0) const uint CAMERA_RAYS_IS_LIST = 0u;
layout(constant_id = 1) const uint CAMERA_RAYS_HAS_LENS = 0u;

vec2 sequence_point(uint index) {
  uvec2 digits = bitfieldReverse(uvec2(index, sobol_second(index))) ^ 0x80000000u;
  return vec2(digits >> 8) * 5.9604644775390625e-8;
}

vec2 film_position(uvec2 pixel, Film film) {
  if (film.is_sequence != 0u) {
    precise vec2 in_sequence = vec2(pixel) + sequence_point(args.sample_index);
    return in_sequence;
  }
  precise float across = (float(args.sample_index) + 0.5) / float(film.samples);
  float down = film.samples == 1u ? 0.5 : float(bitfieldReverse(args.sample_index) >> 8) * 5.9604644775390625e-8;
  precise vec2 position = vec2(float(pixel.x) + across, float(pixel.y) + down);
  return position;
}

vec3 beside_centre(uint ray, Film film) {
  vec2 disk = disk_point(sample_2d(ray, args.sample_index, SAMPLE_LENS)).xy;
  precise vec3 aside = film.lens_right * disk.x + film.lens_down * disk.y;
  return aside;
}

// From the centre of the lens before.
void pass_lens(vec3 aside, Film film, inout vec3 origin, inout vec3 direction) {
  precise vec3 start = origin + aside;
  precise vec3 turned = direction - aside * film.per_focus;
  origin = start;
  direction = turned;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Film film = args.film.at[0];
  uint ray = args.first_ray + i;
  if (CAMERA_RAYS_IS_LIST != 0u) ray = args.pixels.at[i];
  vec2 position = film_position(film_pixel(ray, film), film);
  vec3 direction = camera_direction(position, film);
  vec3 origin = film.position;
  if (CAMERA_RAYS_HAS_LENS != 0u) pass_lens(beside_centre(ray, film), film, origin, direction);
  float far = uintBitsToFloat(0x7f800000u);
  store_ray(args.rays, i, Ray(origin, 0.0, direction, far));
  store_hit(args.hits, i, Hit(far, NO_TRIANGLE, 0.0, 0.0));
}
