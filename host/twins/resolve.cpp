#include <bit>

#include "interface/shade.h"
#include "twins/film_pixel.h"
#include "twins/shading.h"
#include "twins/tone.h"

namespace coppice::twins {

void resolve(const ResolveArgs& args) {
  const Film& film = args.film[0];
  const float exposure = std::bit_cast<float>(args.exposure);
  for (uint i = 0; i < args.ray_count; ++i) {
    const uint samples = args.sample_counts.value ? args.sample_counts[i] : film.samples;
    const vec3 mean = args.radiance[i] / static_cast<float>(samples) * exposure;
    const uvec2 pixel = film_pixel(args.first_ray + i, film);
    args.image[pixel.y * film.width + pixel.x] =
        pixel_of(tone_of(mean, args.tone_curve), args.srgb_thresholds);
  }
}

}  // namespace coppice::twins
