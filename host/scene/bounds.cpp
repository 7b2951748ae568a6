#include "scene/bounds.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace coppice {
namespace {

template <class Counts>
Bounds bounds_of(const Scene& scene, Counts counts) {
  Bounds bounds;
  for (const glm::uvec3 triangle : scene.indices) {
    if (!counts(scene, triangle)) continue;
    for (int corner = 0; corner < 3; ++corner) bounds.add(scene.positions[triangle[corner]]);
  }
  return bounds;
}

}  // namespace

bool is_finite(glm::vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

bool is_active(const Scene& scene, glm::uvec3 triangle) {
  return is_finite(scene.positions[triangle.x]) && is_finite(scene.positions[triangle.y]) &&
         is_finite(scene.positions[triangle.z]);
}

bool is_visible(const Scene& scene, glm::uvec3 triangle) {
  if (!is_active(scene, triangle)) return false;
  const glm::dvec3 a = scene.positions[triangle.x];
  return glm::cross(glm::dvec3{scene.positions[triangle.y]} - a,
                    glm::dvec3{scene.positions[triangle.z]} - a) != glm::dvec3{0};
}

Bounds active_bounds(const Scene& scene) { return bounds_of(scene, is_active); }

Bounds visible_bounds(const Scene& scene) {
  const Bounds bounds = bounds_of(scene, is_visible);
  return bounds.empty() ? active_bounds(scene) : bounds;
}

}  // namespace coppice
