#include "twins/cosine_direction.h"

#include <algorithm>
#include <cmath>

#include "twins/circle.h"
#include "twins/vectors.h"

namespace coppice::twins {

TangentFrame::TangentFrame(const vec3& n) : normal(n) {
  const float side = n.z < 0 ? -1.0f : 1.0f;
  const float a = -1.0f / (side + n.z);
  const float b = n.x * n.y * a;
  tangent = vec3(1.0f + side * n.x * n.x * a, side * b, -side * n.x);
  bitangent = vec3(b, side + n.y * n.y * a, -n.y);
}

vec3 TangentFrame::to_world(float x, float y, float z) const {
  return unit_vector(tangent * x + bitangent * y + normal * z);
}

vec3 cosine_direction(const vec3& normal, const glm::vec2& u) {
  const OnDisk at = disk_at(u);
  const float height = std::sqrt(std::max((1 - at.radius) * (1 + at.radius), 0.0f));
  return TangentFrame(normal).to_world(at.x, at.y, height);
}

}  // namespace coppice::twins
