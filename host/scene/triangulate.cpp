#include "scene/triangulate.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <tuple>

#include "scene/clip_ears.h"
#include "scene/orientation.h"
#include "scene/sweep_polygon.h"

namespace coppice {
namespace {

// Up to so many corners ears are cut first, which makes rounder triangles than the sweep does.
constexpr std::size_t FEW_CORNERS = 256;

// The corners on the two axes on which the polygon's area is largest, in the order that makes it wind to the
// left.
std::vector<glm::vec2> flatten(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon) {
  const glm::dvec3 first = positions[polygon[0]];
  glm::dvec3 normal{0}, low{0}, high{0};
  for (std::size_t i = 0; i < polygon.size(); ++i) {  // Newell's method
    const glm::dvec3 p = glm::dvec3{positions[polygon[i]]} - first;
    const glm::dvec3 q = glm::dvec3{positions[polygon[(i + 1) % polygon.size()]]} - first;
    normal += (glm::dvec3{p.y, p.z, p.x} - glm::dvec3{q.y, q.z, q.x}) *
              (glm::dvec3{p.z, p.x, p.y} + glm::dvec3{q.z, q.x, q.y});
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  // Without an area, as where the two halves of an 8 cancel out: across its least extent.
  const glm::dvec3 size = normal != glm::dvec3{0} ? glm::abs(normal) : low - high;
  const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const float flip = normal[axis] < 0 ? -1.0f : 1.0f;

  std::vector<glm::vec2> flat;
  flat.reserve(polygon.size());
  for (const std::uint32_t index : polygon)
    flat.emplace_back(flip * positions[index][u], positions[index][v]);
  return flat;
}

// Never to the right, no corner that stands twice or lies between its neighbours backwards, and once around.
bool is_convex(const std::vector<glm::vec2>& flat) {
  const auto before = [](glm::vec2 a, glm::vec2 b) { return std::tuple(a.x, a.y) < std::tuple(b.x, b.y); };
  const std::size_t n = flat.size();
  int reversals = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const glm::vec2 a = flat[i], b = flat[(i + 1) % n], c = flat[(i + 2) % n];
    if (b == c || orientation(a, b, c) < 0) return false;
    reversals += before(a, b) != before(b, c);
  }
  return reversals == 2;
}

void fan(std::span<const std::uint32_t> polygon, std::size_t from, std::vector<glm::uvec3>& triangles) {
  const auto corner = [&](std::size_t i) { return polygon[(from + i) % polygon.size()]; };
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    triangles.emplace_back(corner(0), corner(i), corner(i + 1));
  }
}

double twice_area(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct Areas {
  double left = 0, right = 0;  // of the triangles that run to the left and to the right, both positive
};

Areas areas_of(const std::vector<glm::vec2>& flat, const std::vector<glm::uvec3>& cut) {
  Areas areas;
  for (const glm::uvec3 t : cut) {
    const double area = twice_area(flat[t.x], flat[t.y], flat[t.z]);
    (area > 0 ? areas.left : areas.right) += std::abs(area);
  }
  return areas;
}

double twice_area(const std::vector<glm::vec2>& flat) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < flat.size(); ++i) sum += twice_area(flat[0], flat[i], flat[i + 1]);
  return sum;
}

// Triangles of an outline that all run to the left, and are as many as its corners less two, cover each point
// as often as the outline winds around it: so ears prove themselves right. What the sweep gives adds up to
// the outline's area unless that winds around something more than once.
bool cut_outline(const std::vector<glm::vec2>& flat, std::vector<glm::uvec3>& cut) {
  constexpr double within = 1e-6;
  const std::size_t count = flat.size() - 2;
  const bool few = flat.size() <= FEW_CORNERS;
  if (few && clip_ears(flat, cut)) return true;
  std::vector<glm::uvec3> swept;
  if (sweep_polygon(flat, swept) && swept.size() <= count) {
    const Areas areas = areas_of(flat, swept);
    swept.resize(count, glm::uvec3{swept.empty() ? 0 : swept[0].x});
    cut = std::move(swept);
    return std::abs(areas.left - areas.right - twice_area(flat)) <= within * (areas.left + areas.right);
  }
  if (!few) clip_ears(flat, cut);
  const Areas areas = areas_of(flat, cut);
  return areas.right <= within * areas.left;
}

}  // namespace

bool triangulate(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<glm::uvec3>& triangles) {
  std::size_t first = 0;
  if (polygon.size() > 3) {
    const auto broken = std::ranges::find_if(polygon, [&](std::uint32_t i) {
      return !std::isfinite(positions[i].x) || !std::isfinite(positions[i].y) ||
             !std::isfinite(positions[i].z);
    });
    if (broken != polygon.end()) {
      first = static_cast<std::size_t>(broken - polygon.begin());
    } else if (const std::vector<glm::vec2> flat = flatten(positions, polygon); !is_convex(flat)) {
      std::vector<glm::uvec3> cut;
      const bool is_whole = cut_outline(flat, cut);
      for (const glm::uvec3 t : cut) triangles.emplace_back(polygon[t.x], polygon[t.y], polygon[t.z]);
      return is_whole;
    }
  }
  fan(polygon, first, triangles);
  return true;
}

}  // namespace coppice
