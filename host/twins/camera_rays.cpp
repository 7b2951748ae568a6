#include <limits>

#include "interface/trace.h"
#include "twins/circle.h"
#include "twins/film_pixel.h"
#include "twins/sampler.h"
#include "twins/shading.h"

namespace coppice::twins {

namespace {

// Van der Corput's sequence in base 2, to 24 bits.
float radical_inverse(uint index) {
  uint reversed = 0;
  for (uint bit = 0; bit < 24; ++bit) reversed |= (index >> bit & 1u) << (23 - bit);
  return static_cast<float>(reversed) / 16777216.0f;
}

// The second dimension of Sobol's sequence, to 24 bits. Its matrix is Pascal's triangle modulo 2, whose entry
// (row, column) is odd where the row has no digit that the column has not (Lucas).
float sobol(uint index) {
  float value = 0, digit = 0.5f;
  for (uint row = 0; row < 24; ++row, digit /= 2) {
    uint parity = 0;
    for (uint column = row; column < 32; ++column) {
      if ((row & ~column) == 0) parity ^= index >> column & 1u;
    }
    if (parity != 0) value += digit;
  }
  return value;
}

// Adds one half, modulo 1.
float half_on(float x) { return x < 0.5f ? x + 0.5f : x - 0.5f; }

}  // namespace

void camera_rays(const CameraRaysArgs& args) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Film& film = args.film[0];
  float across = (static_cast<float>(args.sample_index) + 0.5f) / static_cast<float>(film.samples);
  float down = film.samples == 1 ? 0.5f : radical_inverse(args.sample_index);
  if (film.is_sequence != 0) {
    across = half_on(radical_inverse(args.sample_index));
    down = half_on(sobol(args.sample_index));
  }
  for (uint i = 0; i < args.ray_count; ++i) {
    const uint ray = args.pixels.value ? args.pixels[i] : args.first_ray + i;
    const uvec2 pixel = film_pixel(ray, film);
    const float x = static_cast<float>(pixel.x) + across;
    const float y = static_cast<float>(pixel.y) + down;
    args.rays[i] = {film.position, 0.0f, film_direction(film, x, y), infinity};
    if (args.has_lens != 0) {
      const OnDisk lens = disk_at(sample_2d(ray, args.sample_index, SAMPLE_LENS));
      const vec3 aside = film.lens_right * lens.x + film.lens_down * lens.y;
      args.rays[i].origin += aside;
      args.rays[i].direction -= aside * film.per_focus;
    }
    args.hits[i] = {infinity, NO_TRIANGLE, 0.0f, 0.0f};
  }
}

}  // namespace coppice::twins
