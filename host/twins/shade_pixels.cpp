#include "interface/shade.h"
#include "twins/film_pixel.h"
#include "twins/shading.h"

namespace coppice::twins {

void shade_pixels(const ShadePixelsArgs& args) {
  const Film& film = args.film[0];
  for (uint i = 0; i < args.ray_count; ++i) {
    const uvec2 pixel = film_pixel(args.first_ray + i, film);
    const vec3 direction =
        film_direction(film, static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f);
    const uint index = args.hits[i].triangle;
    const vec3 colour = index == NO_TRIANGLE
                            ? sky_colour(direction, args.lighting[0])
                            : surface_colour(args.materials[args.material_index[index]],
                                             args.triangles[index], direction, args.lighting[0]);
    args.image[pixel.y * film.width + pixel.x] = pixel_of(colour, args.srgb_thresholds);
  }
}

}  // namespace coppice::twins
