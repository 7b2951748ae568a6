#include "scene/bounds.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "scene/instances.h"

namespace coppice {
namespace {

template <class Counts>
Bounds bounds_of(const Scene& scene, Counts counts) {
  if (!scene.instances.empty()) return bounds_of(boxes_of_instances(scene), counts);
  const auto add_triangles = [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const glm::uvec3 triangle = scene.indices[i];
      if (!counts(scene, triangle)) continue;
      for (int corner = 0; corner < 3; ++corner) bounds.add(scene.positions[triangle[corner]]);
    }
    return bounds;
  };
  const auto unite = [](Bounds a, const Bounds& b) {
    a.low = glm::min(a.low, b.low);
    a.high = glm::max(a.high, b.high);
    return a;
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, scene.indices.size(), 1 << 14), Bounds{},
                              add_triangles, unite);
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
