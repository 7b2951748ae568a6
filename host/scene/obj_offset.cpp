#include "scene/obj_offset.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scene/bounds.h"

namespace coppice {

glm::dvec3 find_offset(const Scene& scene) {
  const Bounds bounds = visible_bounds(scene);
  const double reach = bounds.reach(), extent = bounds.extent();
  if (reach <= FAR * extent) return glm::dvec3{0};
  // Below an ulp of the largest coordinate the box says nothing yet.
  const double grain = std::exp2(std::ceil(std::log2(std::max(extent, 0x1p-23 * reach))));
  return glm::round(bounds.centre() / grain) * grain;
}

std::string describe_offset(glm::dvec3 offset) {
  std::ostringstream text;
  text.precision(17);
  text << "too far from the origin for the details: " << offset.x << ',' << offset.y << ',' << offset.z
       << " subtracted from all coordinates before they are rounded";
  return text.str();
}

}  // namespace coppice
