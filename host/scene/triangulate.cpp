#include "scene/triangulate.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace coppice {
namespace {

// Twice the signed area of a triangle, positive if it turns left.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners projected along the main axis of the polygon's normal, turned so that the polygon runs to the
// left. In double, relative to the first corner: no float coordinates overflow.
std::vector<glm::dvec2> flatten(std::span<const glm::vec3> positions,
                                std::span<const std::uint32_t> polygon) {
  std::vector<glm::dvec3> corners;
  corners.reserve(polygon.size());
  for (const std::uint32_t index : polygon) {
    corners.push_back(glm::dvec3{positions[index]} - glm::dvec3{positions[polygon[0]]});
  }
  glm::dvec3 normal{0};  // Newell's method
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 p = corners[i], q = corners[(i + 1) % corners.size()];
    normal += (glm::dvec3{p.y, p.z, p.x} - glm::dvec3{q.y, q.z, q.x}) *
              (glm::dvec3{p.z, p.x, p.y} + glm::dvec3{q.z, q.x, q.y});
  }
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double flip = normal[axis] < 0 ? -1.0 : 1.0;

  std::vector<glm::dvec2> flat;
  flat.reserve(corners.size());
  for (const glm::dvec3& corner : corners) flat.emplace_back(flip * corner[u], corner[v]);
  return flat;
}

bool is_convex(const std::vector<glm::dvec2>& flat) {
  const std::size_t n = flat.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) >= 0)) return false;
  }
  return true;
}

bool is_ear(const std::vector<glm::dvec2>& flat, const std::vector<std::uint32_t>& ring, std::size_t tip) {
  const std::size_t n = ring.size();
  const glm::dvec2 a = flat[ring[(tip + n - 1) % n]], b = flat[ring[tip]], c = flat[ring[(tip + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 p = flat[ring[i]];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

void clip_ears(const std::vector<glm::dvec2>& flat, std::span<const std::uint32_t> polygon,
               std::vector<glm::uvec3>& triangles) {
  std::vector<std::uint32_t> ring(polygon.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<std::uint32_t>(i);
  std::size_t start = 0;  // going round, instead of always from the first corner, makes rounder triangles
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    std::size_t tip = start % n;  // stays if there is no ear: any corner will do then
    for (std::size_t step = 0; step < n; ++step) {
      if (is_ear(flat, ring, (start + step) % n)) {
        tip = (start + step) % n;
        break;
      }
    }
    triangles.emplace_back(polygon[ring[(tip + n - 1) % n]], polygon[ring[tip]],
                           polygon[ring[(tip + 1) % n]]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(tip));
    start = tip;
  }
  triangles.emplace_back(polygon[ring[0]], polygon[ring[1]], polygon[ring[2]]);
}

}  // namespace

void triangulate(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<glm::uvec3>& triangles) {
  if (polygon.size() > 3 && polygon.size() <= MAX_EAR_CLIPPED) {
    const std::vector<glm::dvec2> flat = flatten(positions, polygon);
    if (!is_convex(flat)) return clip_ears(flat, polygon, triangles);
  }
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    triangles.emplace_back(polygon[0], polygon[i], polygon[i + 1]);
  }
}

}  // namespace coppice
