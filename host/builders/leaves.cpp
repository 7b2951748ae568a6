#include "builders/leaves.h"

#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <stdexcept>

namespace coppice {

bool is_active(const Triangle& triangle) {
  // One bit for each coordinate and no branch: almost every triangle is active.
  bool finite = true;
  for (const vec3& corner : {triangle.a, triangle.b, triangle.c}) {
    for (int axis = 0; axis < 3; ++axis) {
      finite &= std::abs(corner[axis]) <= std::numeric_limits<float>::max();
    }
  }
  return finite;
}

Aabb triangle_box(const Triangle& triangle) {
  return {glm::min(glm::min(triangle.a, triangle.b), triangle.c),
          glm::max(glm::max(triangle.a, triangle.b), triangle.c)};
}

std::vector<Node> make_leaves(std::span<const Triangle> triangles) {
  if (triangles.size() > std::size_t{1} << 31) throw std::length_error("more than 2^31 triangles");
  std::vector<Node> leaves;
  leaves.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!is_active(triangles[i])) continue;
    const Aabb box = triangle_box(triangles[i]);
    leaves.push_back({box.box_min, static_cast<std::uint32_t>(i), box.box_max, 0});
  }
  return leaves;
}

Aabb box_union(const Aabb& a, const Aabb& b) {
  return {glm::min(a.box_min, b.box_min), glm::max(a.box_max, b.box_max)};
}

Aabb bounds_of(std::span<const Node> nodes) {
  const float infinity = std::numeric_limits<float>::infinity();
  Aabb bounds{vec3(infinity), vec3(-infinity)};
  for (const Node& node : nodes) bounds = box_union(bounds, {node.box_min, node.box_max});
  return bounds;
}

}  // namespace coppice
