#pragma once

#include "interface/trace.h"

namespace coppice::twins {

// Where a hit lies in its triangle.
vec3 hit_point(const Triangle& triangle, const Hit& hit);

// That point, moved off the triangle's plane by 2^-20 of its distance from zero and of its size, on the side
// that the unit normal points to: Waechter and Binder 2019, docs/numerics.md.
vec3 leave_surface(const Triangle& triangle, const Hit& hit, const vec3& normal);

}  // namespace coppice::twins
