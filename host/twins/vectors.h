#pragma once

#include "interface/types.h"

namespace coppice::twins {

float dot_product(const vec3& a, const vec3& b);
vec3 cross_product(const vec3& a, const vec3& b);

// However large or small its components are.
float length_of(const vec3& v);

// Zero for a zero vector.
vec3 unit_vector(const vec3& v);

// Unit length; zero for a triangle without area.
vec3 unit_normal(const Triangle& triangle);

}  // namespace coppice::twins
