#include "analysis/hit_room.h"

#include <array>
#include <cfloat>
#include <glm/common.hpp>
#include <glm/ext/vector_double2.hpp>
#include <glm/geometric.hpp>

namespace coppice {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double RELATIVE_ROOM = 0x1p-18;
constexpr double FLUSHED = FLT_MIN;  // a t below may have become 0

double largest_component(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Two unit vectors across a unit vector.
std::array<dvec3, 2> across(const dvec3& along) {
  const dvec3 size = glm::abs(along);
  const int least = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  dvec3 axis(0);
  axis[least] = 1;
  const dvec3 right = glm::normalize(glm::cross(along, axis));
  return {right, glm::cross(along, right)};
}

double from_segment(const dvec2& a, const dvec2& b) {
  const dvec2 edge = b - a;
  const double square = glm::dot(edge, edge);
  const double share = square > 0 ? std::clamp(-glm::dot(a, edge) / square, 0.0, 1.0) : 0.0;
  return glm::length(a + share * edge);
}

bool are_shares(double u, double v) { return u >= 0 && v >= 0 && u <= 1 && v <= 1 && u + v <= 1 + 0x1p-20; }

double side_of(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

HitRoom::HitRoom(const ExactLine& line, const Triangle& triangle)
    : length(glm::length(line.direction)),
      along_(line.direction / length),
      a_(dvec3(triangle.a) - line.origin),
      to_b_(dvec3(triangle.b) - dvec3(triangle.a)),
      to_c_(dvec3(triangle.c) - dvec3(triangle.a)) {
  const std::array corners = {a_, dvec3(triangle.b) - line.origin, dvec3(triangle.c) - line.origin};
  const auto [right, up] = across(along_);
  std::array<dvec2, 3> seen;
  std::array<double, 3> depths;
  reach = 0;
  for (int i = 0; i < 3; ++i) {
    reach = std::max(reach, largest_component(corners[i]));
    seen[i] = {glm::dot(corners[i], right), glm::dot(corners[i], up)};
    depths[i] = glm::dot(corners[i], along_);
  }
  delta = RELATIVE_ROOM * reach;
  low_depth_ = *std::ranges::min_element(depths) - delta;
  high_depth_ = *std::ranges::max_element(depths) + delta;

  std::array<double, 3> sides;
  border = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    sides[i] = side_of(seen[i], seen[(i + 1) % 3]);
    border = std::min(border, from_segment(seen[i], seen[(i + 1) % 3]));
  }
  const auto [least, greatest] = std::ranges::minmax(sides);
  gap = least >= 0 || greatest <= 0 ? 0 : border;

  const dvec3 normal = glm::cross(to_b_, to_c_);
  const double twice_area = glm::length(normal);
  const double longest =
      std::max({glm::dot(to_b_, to_b_), glm::dot(to_c_, to_c_), glm::dot(to_c_ - to_b_, to_c_ - to_b_)});
  normal_ = normal / twice_area;
  sliver_ = std::max(1.0, longest / twice_area);
  const double cosine = glm::dot(normal_, along_);
  slope_ = std::abs(cosine);
  plane_depth_ = slope_ > 0 ? glm::dot(a_, normal_) / cosine : 0;
}

double HitRoom::room() const { return delta * sliver_ / slope_; }

Interval HitRoom::distances() const {
  const double low = std::max(low_depth_, plane_depth_ - room());
  const double high = std::min(high_depth_, plane_depth_ + room());
  return {low / length - FLUSHED, high / length + FLUSHED};
}

bool HitRoom::admits_distance(double t) const {
  const double depth = t * length, flushed = FLUSHED * length;
  const double off_plane = std::abs(glm::dot(depth * along_ - a_, normal_));
  return depth >= low_depth_ - flushed && depth <= high_depth_ + flushed &&
         off_plane <= delta * sliver_ + flushed;
}

bool HitRoom::admits_coordinates(double u, double v) const {
  if (!are_shares(u, v)) return false;
  const dvec3 point = a_ + u * to_b_ + v * to_c_;
  return !(glm::length(point - plane_depth_ * along_) > 2 * room() + delta);
}

bool HitRoom::admits_on_segment(const Hit& hit) const {
  if (!are_shares(hit.u, hit.v)) return false;
  const dvec3 point = a_ + double{hit.u} * to_b_ + double{hit.v} * to_c_;
  const double depth = glm::dot(point, along_);
  return glm::length(point - depth * along_) <= 2 * delta &&
         std::abs(depth - hit.t * length) <= 2 * delta + FLUSHED * length;
}

}  // namespace coppice
