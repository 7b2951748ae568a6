#pragma once

#include "interface/trace.h"

namespace coppice::twins {

// Slab test of the twins, after Ize 2013: false only if the ray misses the box for t in [t_min, t_max].
// `enter` is where it enters, at least t_min.
bool ray_meets_box(const Ray& ray, const vec3& box_min, const vec3& box_max, float t_min, float t_max,
                   float& enter);

// Moller and Trumbore 1997. Keeps the closer hit in `hit`, of equally close ones the one with the smaller
// index.
void ray_meets_triangle(const Ray& ray, const Triangle& triangle, uint index, Hit& hit);

// False for a ray with a NaN, an empty range or no direction.
bool ray_is_sound(const Ray& ray);

float dot_product(const vec3& a, const vec3& b);
vec3 cross_product(const vec3& a, const vec3& b);

// Zero for a zero vector.
vec3 unit_vector(const vec3& v);

// How far a padded slab interval reaches beyond the computed one, as a factor.
inline constexpr float slab_pad = 1.0f + 0x1p-20f;

}  // namespace coppice::twins
