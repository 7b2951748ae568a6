#include "twins/light_source.h"

#include <cfloat>
#include <cmath>

#include "twins/vectors.h"

namespace coppice::twins {

namespace {

// The largest component to [1, 2) by a power of two, and components below 2^-40 to 0.
vec3 near_one(const vec3& v) {
  const float largest = std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  if (largest < FLT_MIN) return vec3(0);
  const int exponent = std::isfinite(largest) ? std::ilogb(largest) : 128;
  vec3 result(0);
  for (int axis = 0; axis < 3; ++axis) {
    const double scaled = std::ldexp(static_cast<double>(v[axis]), -exponent);
    if (!(std::fabs(scaled) < 0x1p-40)) result[axis] = static_cast<float>(scaled);
  }
  return result;
}

vec3 any_normal(const Triangle& t) {
  return near_one(cross_product(near_one(t.b - t.a), near_one(t.c - t.a)));
}

}  // namespace

vec3 light_direction(const LightSource& light, const vec3& point) {
  return light.kind == LIGHT_POINT ? light.place - point : light.place;
}

bool faces_light(const Triangle& triangle, const vec3& ray_direction, const vec3& to_light) {
  const vec3 normal = any_normal(triangle);
  const float light_side = dot_product(normal, near_one(to_light));
  const bool from_behind = dot_product(normal, near_one(ray_direction)) > 0;
  return from_behind ? light_side < 0 : light_side > 0;
}

vec3 camera_side_normal(const Triangle& triangle, const vec3& ray_direction) {
  const vec3 normal = unit_normal(triangle);
  return dot_product(any_normal(triangle), near_one(ray_direction)) > 0 ? -normal : normal;
}

}  // namespace coppice::twins
