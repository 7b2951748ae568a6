#include "scene/corner_attributes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace coppice {
namespace {

// The transpose of the inverse but for a positive factor, of matrices without an inverse too.
glm::dmat3 for_normals(const glm::dmat4& transform) {
  const glm::dmat3 m(transform);
  const glm::dmat3 cofactors{glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
  return glm::dot(m[0], cofactors[0]) < 0 ? -1.0 * cofactors : cofactors;
}

glm::vec3 turned(const glm::dmat3& matrix, glm::vec3 normal) {
  const glm::dvec3 result = matrix * glm::dvec3(normal);
  const double length = glm::length(result);
  return length > 0 && std::isfinite(length) ? glm::vec3(result / length) : normal;
}

// Appends the values that some triangles' corners have, as a block from the least index to the greatest, and
// the triangles' indices.
template <class Value, class Change>
void append_values(const std::vector<Value>& from, const std::vector<glm::uvec3>& index, std::size_t first,
                   std::size_t count, bool swaps_corners, Change change, std::vector<Value>& to,
                   std::vector<glm::uvec3>& to_index) {
  std::uint32_t low = NO_ATTRIBUTE, end = 0;
  const auto each = [&](auto visit) {
    for (std::size_t t = first; t < first + count; ++t) visit(index[t]);
  };
  each([&](const glm::uvec3& corners) {
    for (int corner = 0; corner < 3; ++corner) {
      if (corners[corner] == NO_ATTRIBUTE) continue;
      low = std::min(low, corners[corner]);
      end = std::max(end, corners[corner] + 1);
    }
  });
  const auto base = static_cast<std::uint32_t>(to.size());
  for (std::uint32_t i = low; i < end; ++i) to.push_back(change(from[i]));
  each([&](glm::uvec3 corners) {
    for (int corner = 0; corner < 3; ++corner) {
      if (corners[corner] != NO_ATTRIBUTE) corners[corner] = corners[corner] - low + base;
    }
    to_index.push_back(swaps_corners ? glm::uvec3(corners.x, corners.z, corners.y) : corners);
  });
}

}  // namespace

glm::vec3 moved_normal(const glm::dmat4& transform, glm::vec3 normal) {
  return transform == glm::dmat4(1.0) ? normal : turned(for_normals(transform), normal);
}

void append_corner_attributes(const Scene& from, std::size_t first, std::size_t count,
                              const CornerPlacement& placement, Scene& to) {
  const std::size_t before = to.indices.size() - count;
  const glm::uvec3 none(NO_ATTRIBUTE);
  if (!from.texcoord_index.empty()) {
    to.texcoord_index.resize(before, none);
    append_values(
        from.texcoords, from.texcoord_index, first, count, placement.swaps_corners,
        [](glm::vec2 texcoord) { return texcoord; }, to.texcoords, to.texcoord_index);
  } else if (!to.texcoord_index.empty()) {
    to.texcoord_index.resize(to.indices.size(), none);
  }
  if (placement.keeps_normals && !from.normal_index.empty()) {
    const bool stays = placement.transform == glm::dmat4(1.0);
    const glm::dmat3 matrix = for_normals(placement.transform);
    to.normal_index.resize(before, none);
    append_values(
        from.normals, from.normal_index, first, count, placement.swaps_corners,
        [&](glm::vec3 normal) { return stays ? normal : turned(matrix, normal); }, to.normals,
        to.normal_index);
  } else if (!to.normal_index.empty()) {
    to.normal_index.resize(to.indices.size(), none);
  }
}

void drop_normals(Scene& scene) {
  scene.normals = {};
  scene.normal_index = {};
}

}  // namespace coppice
