#pragma once

#include "interface/shade.h"

namespace coppice::twins {

// Of a ray that hits nothing.
vec3 sky_colour(const vec3& direction, const Lighting& lighting);

// Of one that hits this triangle.
vec3 surface_colour(const SurfaceMaterial& material, const Triangle& triangle, const vec3& direction,
                    const Lighting& lighting);

// Through a point of the film.
vec3 film_direction(const Film& film, float x, float y);

// RGBA8, sRGB. The code of NaN is 0.
uint pixel_of(const vec3& colour, READS(UintBuffer) srgb_thresholds);

}  // namespace coppice::twins
