#include "twins/intersect.h"

#include <cfloat>
#include <cmath>
#include <limits>
#include <utility>

namespace coppice::twins {

float dot_product(const vec3& a, const vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

vec3 cross_product(const vec3& a, const vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

vec3 unit_vector(const vec3& v) {
  const float largest = std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  if (largest == 0) return vec3(0);
  const vec3 scaled(v.x / largest, v.y / largest, v.z / largest);
  const float length = std::sqrt(dot_product(scaled, scaled));
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

bool ray_meets_box(const Ray& ray, const vec3& box_min, const vec3& box_max, float t_min, float t_max,
                   float& enter) {
  enter = t_min;
  for (int axis = 0; axis < 3; ++axis) {
    const float direction = ray.direction[axis];
    const float inverse = std::fabs(direction) < FLT_MIN
                              ? std::copysign(std::numeric_limits<float>::infinity(), direction)
                              : 1.0f / direction;
    float near = (box_min[axis] - ray.origin[axis]) * inverse;
    float far = (box_max[axis] - ray.origin[axis]) * inverse;
    if (inverse < 0) std::swap(near, far);
    far *= slab_pad;
    if (near > enter) enter = near;  // false for the NaN of a ray in the slab's plane
    if (far < t_max) t_max = far;
  }
  return enter <= t_max;
}

void ray_meets_triangle(const Ray& ray, const Triangle& triangle, uint index, Hit& hit) {
  const vec3 edge_b = triangle.b - triangle.a, edge_c = triangle.c - triangle.a;
  const vec3 p = cross_product(ray.direction, edge_c);
  const float determinant = dot_product(edge_b, p);
  if (determinant == 0) return;
  const vec3 from_a = ray.origin - triangle.a;
  const vec3 q = cross_product(from_a, edge_b);
  const float size = std::fabs(determinant);
  const float u = std::copysign(1.0f, determinant) * dot_product(from_a, p);
  const float v = std::copysign(1.0f, determinant) * dot_product(ray.direction, q);
  const bool inside = u >= 0 && v >= 0 && u + v <= size;
  if (!inside) return;
  const float t = dot_product(edge_c, q) / determinant;
  const bool closer = t < hit.t || (t == hit.t && index < hit.triangle);
  if (t >= ray.t_min && closer) hit = {t, index, u / size, v / size};
}

bool ray_is_sound(const Ray& ray) {
  bool moves = false;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isnan(ray.origin[axis]) || std::isnan(ray.direction[axis])) return false;
    moves = moves || ray.direction[axis] != 0;
  }
  return moves && ray.t_min <= ray.t_max;
}

}  // namespace coppice::twins
