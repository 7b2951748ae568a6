#include "twins/trace_ray.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "twins/error_free.h"

namespace coppice::twins {

namespace {

constexpr float negligible_component = 0x1p-64f;
constexpr float far_origin = 16;  // in scene sizes
constexpr float farthest_move = 0x1p100f;
constexpr float box_room = 24 * 0x1p-24f;

float largest(const vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

bool is_finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

float farthest(float low, float high, float origin) {
  return std::max(std::fabs(low - origin), std::fabs(high - origin));
}

}  // namespace

TraceRay::TraceRay(const Ray& given) : origin(given.origin), given_(given) {
  is_sound = is_finite(given.origin) && is_finite(given.direction) && largest(given.direction) >= FLT_MIN &&
             given.t_min <= given.t_max;
  if (!is_sound) return;
  const int exponent = std::max(std::ilogb(largest(given.direction)), -125);
  scale_ = std::ldexp(1.0f, 1 - exponent);
  t_min = std::ldexp(given.t_min, exponent - 1);
  for (int k = 0; k < 3; ++k) {
    const float component = given.direction[k] * scale_;
    const bool counts = std::isnormal(given.direction[k]) && std::fabs(component) >= negligible_component;
    direction[k] = counts ? component : std::copysign(0.0f, component);
    inverse[k] = direction[k] == 0 ? std::copysign(std::numeric_limits<float>::infinity(), direction[k])
                                   : 1.0f / direction[k];
    room[k] = direction[k] == 0 ? 0.0f : std::fabs(inverse[k]) * box_room;
  }
  axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(direction[k]) > std::fabs(direction[axis])) axis = k;
  }
  stretch = 1.0f / direction[axis];
  for (int k = 0; k < 2; ++k) shear[k] = direction[(axis + 1 + k) % 3] / direction[axis];
}

void TraceRay::approach(const vec3& box_min, const vec3& box_max) {
  float size = 0, reach = 0;
  for (int k = 0; k < 3; ++k) {
    size = std::max(size, box_max[k] - box_min[k]);
    reach = std::max(reach, farthest(box_min[k], box_max[k], origin[k]));
  }
  if (reach <= far_origin * size) return;
  const float to_centre = (box_min[axis] * 0.5f + box_max[axis] * 0.5f) - origin[axis];
  const float t = to_centre * stretch * (1.0f - 0x1p-20f) - 2.0f * size;
  if (!(t > 0 && t < farthest_move)) return;
  for (int k = 0; k < 3; ++k) {
    const Unrounded way = exact_product(direction[k], t);
    const Unrounded sum = exact_sum(origin[k], way.value);
    origin[k] = sum.value + (sum.rest + way.rest);
  }
  t_min = std::max(t_min - t, 0.0f);
  moved_ = t;
}

Hit TraceRay::prepared(const Hit& given) const {
  return {given.t * (1.0f / scale_) - moved_, given.triangle, given.u, given.v};
}

void TraceRay::keep(const Hit& hit, Hit& so_far) const {
  if (hit.triangle == so_far.triangle) return;
  const float t = given_t(hit.t);
  if (std::isinf(t)) return;
  so_far = {std::min(std::max(t, given_.t_min), so_far.t), hit.triangle, hit.u, hit.v};
}

}  // namespace coppice::twins
