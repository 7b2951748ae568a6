#pragma once

#include "interface/trace.h"

namespace coppice::twins {

// The point of a hit, moved off the triangle's plane by 2^-20 of its distance from zero and of its size, on
// the side that the unit normal points to: Waechter and Binder 2019, docs/numerics.md.
vec3 leave_surface(const Triangle& triangle, const Hit& hit, const vec3& normal);

}  // namespace coppice::twins
