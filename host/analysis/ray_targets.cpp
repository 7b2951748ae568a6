#include "analysis/ray_targets.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "builders/leaves.h"

namespace coppice {

using glm::dvec3;

std::uint64_t DoubleRandom::next() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

dvec3 DoubleRandom::in_cube() {
  const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
  return {x, y, z};
}

dvec3 DoubleRandom::direction() {
  while (true) {
    const dvec3 p = in_cube();
    const double square = glm::dot(p, p);
    if (square > 0.01 && square <= 1.0) return p / std::sqrt(square);
  }
}

RayTargets::RayTargets(std::span<const Triangle> triangles, std::span<const Node> nodes) : nodes_(nodes) {
  std::ranges::copy_if(triangles, std::back_inserter(triangles_), is_active);
  if (triangles_.empty()) {
    triangles_.push_back({vec3(-1, -1, 0), vec3(1, -1, 0), vec3(0, 1, 1)});
    nodes_ = {};
  }
  dvec3 low(triangles_[0].a), high(triangles_[0].a);
  for (const Triangle& triangle : triangles_) {
    const Aabb box = triangle_box(triangle);
    low = glm::min(low, dvec3(box.box_min));
    high = glm::max(high, dvec3(box.box_max));
  }
  centre_ = 0.5 * (low + high);
  const dvec3 half = 0.5 * (high - low);
  size_ = std::max({half.x, half.y, half.z});
  if (size_ == 0) size_ = std::max(1.0, glm::length(centre_));
}

const Triangle& RayTargets::triangle(DoubleRandom& random) const {
  return triangles_[random.below(triangles_.size())];
}

Aabb RayTargets::box(DoubleRandom& random) const {
  if (nodes_.empty()) return triangle_box(triangle(random));
  const Node& node = nodes_[random.below(nodes_.size())];
  return {node.box_min, node.box_max};
}

vec3 RayTargets::origin(const Triangle& near, DoubleRandom& random) const {
  if (random.coin()) return to_float(centre_ + 2 * size_ * random.in_cube());
  const Aabb box = triangle_box(near);
  const dvec3 sides = dvec3(box.box_max) - dvec3(box.box_min);
  const double size = std::max({sides.x, sides.y, sides.z, 1e-6 * size_});
  return to_float(dvec3(near.a) + 4 * size * random.in_cube());
}

vec3 to_float(const dvec3& point) { return vec3(glm::clamp(point, dvec3(-FLT_MAX), dvec3(FLT_MAX))); }

vec3 aim(const vec3& origin, const dvec3& target, DoubleRandom& random) {
  const dvec3 way = target - dvec3(origin);
  const double length = glm::length(way);
  const bool is_unit = random.coin() || length > 1e30 || length < 1e-30;
  if (length == 0) return vec3(random.direction());
  return is_unit ? vec3(way / length) : vec3(way);
}

dvec3 corner_of(const Triangle& triangle, DoubleRandom& random) {
  const std::uint32_t corner = random.below(3);
  return dvec3(corner == 0 ? triangle.a : corner == 1 ? triangle.b : triangle.c);
}

dvec3 edge_point_of(const Triangle& triangle, DoubleRandom& random) {
  const std::uint32_t first = random.below(3);
  const vec3 corners[] = {triangle.a, triangle.b, triangle.c};
  const double share = random.below(4) == 0 ? 0.5 : random.uniform();
  return (1 - share) * dvec3(corners[first]) + share * dvec3(corners[(first + 1) % 3]);
}

dvec3 inner_point_of(const Triangle& triangle, DoubleRandom& random) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return (1 - u - v) * dvec3(triangle.a) + u * dvec3(triangle.b) + v * dvec3(triangle.c);
}

}  // namespace coppice
