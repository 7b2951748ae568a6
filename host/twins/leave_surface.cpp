#include "twins/leave_surface.h"

#include <cmath>

namespace coppice::twins {

namespace {

float largest_of(float a, float b, float c) {
  return std::fmax(std::fmax(std::fabs(a), std::fabs(b)), std::fabs(c));
}

}  // namespace

vec3 hit_point(const Triangle& t, const Hit& hit) {
  return t.a * (1.0f - hit.u - hit.v) + t.b * hit.u + t.c * hit.v;
}

vec3 leave_surface(const Triangle& t, const Hit& hit, const vec3& normal) {
  const vec3 edge_b = t.b - t.a, edge_c = t.c - t.a;
  const float size =
      std::fmax(largest_of(edge_b.x, edge_b.y, edge_b.z), largest_of(edge_c.x, edge_c.y, edge_c.z));
  float distance = 0;
  for (int axis = 0; axis < 3; ++axis) {
    distance += std::fabs(normal[axis]) * ((largest_of(t.a[axis], t.b[axis], t.c[axis]) + size) * 0x1p-20f);
  }
  return hit_point(t, hit) + normal * distance;
}

}  // namespace coppice::twins
