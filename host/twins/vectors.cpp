#include "twins/vectors.h"

#include <cmath>

namespace coppice::twins {

float dot_product(const vec3& a, const vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

vec3 cross_product(const vec3& a, const vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

float length_of(const vec3& v) {
  const float largest = std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  if (largest == 0) return 0;
  const vec3 scaled(v.x / largest, v.y / largest, v.z / largest);
  return largest * std::sqrt(dot_product(scaled, scaled));
}

vec3 unit_vector(const vec3& v) {
  const float largest = std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  if (largest == 0) return vec3(0);
  const vec3 scaled(v.x / largest, v.y / largest, v.z / largest);
  const float length = std::sqrt(dot_product(scaled, scaled));
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

vec3 unit_normal(const Triangle& triangle) {
  return unit_vector(
      cross_product(unit_vector(triangle.b - triangle.a), unit_vector(triangle.c - triangle.a)));
}

}  // namespace coppice::twins
