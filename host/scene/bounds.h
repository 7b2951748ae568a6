#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "scene/scene.h"

namespace coppice {

// In double, so that neither the extent nor the centre of a scene at the ends of the range of float
// overflows.
struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::max()};
  glm::dvec3 high{std::numeric_limits<double>::lowest()};

  bool empty() const { return low.x > high.x; }
  glm::dvec3 centre() const { return empty() ? glm::dvec3{0} : 0.5 * (low + high); }
  double extent() const {  // the longest side
    const glm::dvec3 size = empty() ? glm::dvec3{0} : high - low;
    return glm::max(size.x, glm::max(size.y, size.z));
  }
  double reach() const {  // the largest coordinate
    const glm::dvec3 size = empty() ? glm::dvec3{0} : glm::max(glm::abs(low), glm::abs(high));
    return glm::max(size.x, glm::max(size.y, size.z));
  }
  void add(glm::dvec3 point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

// Whether all three coordinates are.
bool is_finite(glm::vec3 p);

// Whether all corners are finite.
bool is_active(const Scene& scene, glm::uvec3 triangle);

// Whether a ray can hit it: it is active and has an area.
bool is_visible(const Scene& scene, glm::uvec3 triangle);

// Of the active triangles.
Bounds active_bounds(const Scene& scene);

// Of the visible triangles, of the active ones where none is visible.
Bounds visible_bounds(const Scene& scene);

}  // namespace coppice
