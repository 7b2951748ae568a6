// Which side of a triangle a direction lies on, by add, multiply and compare alone: what decides whether there is a
// shadow ray must come out alike on every device, or all rays behind it in the queue change places. Each vector is
// brought to about 1 by a power of two before it is multiplied, so that nothing overflows and no denormal comes up.
#include "lib/exact_vector.glsl"
#include "lib/normalised.glsl"

const float FACING_FLOOR = 9.094947017729282e-13;  // 2^-40

// Times the power of two that brings the largest component to [1, 2); components below 2^-40 then count as 0.
vec3 about_one(vec3 v) {
  vec3 size = abs(v);
  float largest = max(max(size.x, size.y), size.z);
  if (largest < 1.1754943508222875e-38) return vec3(0.0);
  int exponent = 127 - biased_exponent(largest);
  int half_exponent = exponent >> 1;
  precise vec3 scaled = v * power_of_two(half_exponent) * power_of_two(exponent - half_exponent);
  return mix(scaled, vec3(0.0), lessThan(abs(scaled), vec3(FACING_FLOOR)));
}

// Of no particular length; zero for a triangle without area.
vec3 facing_normal(Triangle triangle) {
  precise vec3 edge_b = triangle.b - triangle.a;
  precise vec3 edge_c = triangle.c - triangle.a;
  return about_one(exact_cross(about_one(edge_b), about_one(edge_c)));
}

// Positive on the side to which the normal points.
float side_of(vec3 facing, vec3 direction) { return exact_dot(facing, about_one(direction)); }
