#include <algorithm>
#include <bit>

#include "interface/trace.h"
#include "twins/film_pixel.h"

namespace coppice::twins {

void resolve(const ResolveArgs& args) {
  const Film& film = args.film[0];
  const uint* const thresholds = &args.srgb_thresholds[0];
  // The code of NaN is 0.
  const auto srgb_code = [&](float linear) {
    const auto above = std::upper_bound(thresholds + 1, thresholds + 256, linear, [](float value, uint bits) {
      return !(value >= std::bit_cast<float>(bits));
    });
    return static_cast<uint>(above - thresholds - 1);
  };
  for (uint i = 0; i < args.ray_count; ++i) {
    const vec3 mean = args.radiance[i] / static_cast<float>(film.samples);
    const uvec2 pixel = film_pixel(args.first_ray + i, film);
    args.image[pixel.y * film.width + pixel.x] =
        0xff000000u | srgb_code(mean.z) << 16 | srgb_code(mean.y) << 8 | srgb_code(mean.x);
  }
}

}  // namespace coppice::twins
