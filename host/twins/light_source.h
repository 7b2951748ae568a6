#pragma once

#include "interface/lights.h"

namespace coppice::twins {

// From a point towards a light; not of unit length.
vec3 light_direction(const LightSource& light, const vec3& point);

// Whether camera and light are on the same side of the hit's triangle; of neither side is neither.
bool faces_light(const Triangle& triangle, const vec3& ray_direction, const vec3& to_light);

// The unit normal on the side that a ray comes from, as shadow rays take it.
vec3 camera_side_normal(const Triangle& triangle, const vec3& ray_direction);

}  // namespace coppice::twins
