#include "interface/trace.h"
#include "twins/film_pixel.h"
#include "twins/shading.h"

namespace coppice::twins {

void resolve(const ResolveArgs& args) {
  const Film& film = args.film[0];
  for (uint i = 0; i < args.ray_count; ++i) {
    const vec3 mean = args.radiance[i] / static_cast<float>(film.samples);
    const uvec2 pixel = film_pixel(args.first_ray + i, film);
    args.image[pixel.y * film.width + pixel.x] = pixel_of(mean, args.srgb_thresholds);
  }
}

}  // namespace coppice::twins
