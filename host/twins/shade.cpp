#include "interface/shade.h"

#include "twins/material_of.h"
#include "twins/shading.h"

namespace coppice::twins {

void shade(const ShadeArgs& args) {
  for (uint i = 0; i < args.ray_count; ++i) {
    const uint index = args.hits[i].triangle;
    const vec3& direction = args.rays[i].direction;
    const vec3 colour =
        index == NO_TRIANGLE
            ? sky_colour(direction, args.lighting[0])
            : surface_colour(material_of(args, i, index), args.triangles[index], direction, args.lighting[0]);
    args.radiance[i] = args.sample_index == 0 ? colour : args.radiance[i] + colour;
  }
}

}  // namespace coppice::twins
