#include "interface/paths.h"

namespace coppice::twins {

namespace {

// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering": PCG.
uint hash_of_pixel(uint pixel) {
  const uint state = pixel * 747796405u + 2891336453u;
  const uint word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

}  // namespace

void path_start(const PathStartArgs& args) {
  for (uint i = 0; i < args.ray_count; ++i) {
    if (args.sample_index == 0) args.radiance[i] = vec3(0);
    const uint pixel = args.pixels.value == 0 ? args.first_ray + i : args.pixels[i];
    args.paths[i] = {vec3(1), i, 0, 0, hash_of_pixel(pixel), 0};
  }
  if (args.ray_count > 0) args.count[0] = args.ray_count;
}

}  // namespace coppice::twins
