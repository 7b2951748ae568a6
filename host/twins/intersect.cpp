#include "twins/intersect.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twins/error_free.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

void keep_closer(const TraceRay& ray, const Hit& candidate, Hit& hit) {
  const bool closer = candidate.t < hit.t || (candidate.t == hit.t && candidate.triangle < hit.triangle);
  if (candidate.t >= ray.t_min && closer) hit = candidate;
}

void meet_fast(const TraceRay& ray, const Triangle& triangle, uint index, Hit& hit) {
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
  if (inside) keep_closer(ray, {dot_product(edge_c, q) / determinant, index, u / size, v / size}, hit);
}

// A corner in the ray's own space, where the ray is the z axis.
struct Corner {
  float x, y, z;
};

Corner sheared(const TraceRay& ray, const vec3& position) {
  const vec3 from_origin = position - ray.origin;
  const float z = from_origin[ray.axis];
  return {from_origin[(ray.axis + 1) % 3] - ray.shear[0] * z,
          from_origin[(ray.axis + 2) % 3] - ray.shear[1] * z, z};
}

// On which side of each edge, bc, ca and ab, the ray passes.
struct Sides {
  float bc, ca, ab;

  float sum() const { return bc + ca + ab; }
  bool any_zero() const { return bc == 0 || ca == 0 || ab == 0; }
  bool agree() const { return !((bc < 0 || ca < 0 || ab < 0) && (bc > 0 || ca > 0 || ab > 0)); }
};

float plain_difference(float a, float b, float c, float d) { return a * b - c * d; }

template <class Difference>
Sides sides_of(const Corner& a, const Corner& b, const Corner& c, Difference difference) {
  return {difference(c.x, b.y, c.y, b.x), difference(a.x, c.y, a.y, c.x), difference(b.x, a.y, b.y, a.x)};
}

void meet_watertight(const TraceRay& ray, const Triangle& triangle, uint index, Hit& hit) {
  Corner corners[3] = {sheared(ray, triangle.a), sheared(ray, triangle.b), sheared(ray, triangle.c)};
  float size = 0;
  for (const Corner& corner : corners) size = std::max({size, std::fabs(corner.x), std::fabs(corner.y)});
  if (!(size > 0) || !std::isfinite(size)) return;
  const float scale = std::ldexp(1.0f, std::clamp(-std::ilogb(size), -126, 127));
  for (Corner& corner : corners) {
    corner.x *= scale;
    corner.y *= scale;
  }
  const auto& [a, b, c] = corners;
  Sides sides = sides_of(a, b, c, plain_difference);
  if (!sides.agree()) return;
  // Zeroes may be lost differences, and small ones are mostly rounding.
  if (sides.any_zero() || std::fabs(sides.sum()) < 0x1p-6f) sides = sides_of(a, b, c, difference_of_products);
  const float sum = sides.sum();
  if (!sides.agree() || sum == 0) return;
  const float w = sides.bc / sum, u = sides.ca / sum, v = sides.ab / sum;
  keep_closer(ray, {(w * a.z + u * b.z + v * c.z) * ray.stretch, index, u, v}, hit);
}

}  // namespace

bool ray_meets_box(const TraceRay& ray, const vec3& box_min, const vec3& box_max, uint box_test, float t_max,
                   float& enter) {
  float reach = 0;
  if (box_test == BOX_ROBUST) {
    for (int axis = 0; axis < 3; ++axis)
      reach = std::max(
          {reach, std::fabs(box_min[axis] - ray.origin[axis]), std::fabs(box_max[axis] - ray.origin[axis])});
  }
  return ray_meets_box_within(ray, box_min, box_max, reach, t_max, enter);
}

bool ray_meets_box_within(const TraceRay& ray, const vec3& box_min, const vec3& box_max, float reach,
                          float t_max, float& enter) {
  enter = ray.t_min;
  for (int axis = 0; axis < 3; ++axis) {
    float near = (box_min[axis] - ray.origin[axis]) * ray.inverse[axis];
    float far = (box_max[axis] - ray.origin[axis]) * ray.inverse[axis];
    if (ray.inverse[axis] < 0) std::swap(near, far);
    near -= ray.room[axis] * reach;
    far += ray.room[axis] * reach;
    if (near > enter) enter = near;  // false for the NaN of a ray in the slab's plane
    if (far < t_max) t_max = far;
  }
  return enter <= t_max;
}

void ray_meets_triangle(const TraceRay& ray, const Triangle& triangle, uint index, uint triangle_test,
                        Hit& hit) {
  if (triangle_test == TRIANGLE_WATERTIGHT) {
    meet_watertight(ray, triangle, index, hit);
  } else {
    meet_fast(ray, triangle, index, hit);
  }
}

}  // namespace coppice::twins
