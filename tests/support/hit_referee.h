#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "interface/trace.h"

namespace coppice {

// What a tracer in float may do to a hit, and what it may not. All is measured in double with formulas that
// no tracer here uses, in the length `blur` of a ray at a triangle:
//   blur = ROUNDING * reach / sharpness,
//   reach = distance from the ray's origin to the farthest corner: float rounds differences in proportion to
//   it, sharpness = |d . (e_b x e_c)| / (|d| |e_b| |e_c|): 1 where the ray is square to a right angle at
//   corner a, small for a needle or a ray almost in the triangle's plane, where rounding weighs the more.
enum class Verdict {
  same,  // the same triangle, or both miss; distances within SAME_DISTANCE of the reach
  tie,   // two triangles that both are met, as far away as each other to within SAME_DISTANCE of the reach
  borderline,  // one saw the nearer triangle and the other did not, and the line passes within a blur of its
               // edge; or both saw the same triangle, with distances within a blur
  wrong,       // none of these, or a claimed hit is none: its point is more than a blur off the triangle
};

class HitReferee {
 public:
  static constexpr double ROUNDING = 0x1p-20;  // 16 roundings of a float; Embree's hits need 5 to 8
  static constexpr double SAME_DISTANCE = 1e-5;

  explicit HitReferee(std::span<const Triangle> triangles) : triangles_(triangles) {}

  // Of what two tracers found for one ray of finite origin and direction, t_min = 0 and no end.
  Verdict judge(const Ray& ray, const Hit& one, const Hit& other) const {
    const Hit& near = other.t < one.t ? other : one;
    const Hit& far = &near == &one ? other : one;
    if (near.triangle == NO_TRIANGLE) return Verdict::same;
    const Meeting at_near = meet(ray, triangles_[near.triangle]);
    if (!at_near.may_be_met_at(near.t)) return Verdict::wrong;
    if (far.triangle != NO_TRIANGLE) {
      if (!meet(ray, triangles_[far.triangle]).may_be_met_at(far.t)) return Verdict::wrong;
      const bool as_far = at_near.length_of(far.t - near.t) <= SAME_DISTANCE * at_near.reach;
      if (as_far) return near.triangle == far.triangle ? Verdict::same : Verdict::tie;
      if (near.triangle == far.triangle) return Verdict::borderline;  // both within a blur of the plane
    }
    return at_near.edge_distance <= at_near.blur ? Verdict::borderline : Verdict::wrong;
  }

 private:
  using dvec3 = glm::dvec3;

  // A ray's line and a triangle. Lengths in world units.
  struct Meeting {
    double reach, blur;
    double t;                 // where the line crosses the plane, in lengths of the direction
    double direction_length;  // of the ray
    double edge_distance;     // from the line to the nearest edge
    bool inside;              // the line crosses the triangle

    double length_of(double t_difference) const { return t_difference * direction_length; }
    // False for a triangle without area and for a line in its plane, where the blur is infinite.
    bool may_be_met_at(double claimed_t) const {
      return std::isfinite(blur) && claimed_t >= 0.0 && length_of(std::abs(claimed_t - t)) <= blur &&
             (inside || edge_distance <= blur);
    }
  };

  // Between the line through the origin along the unit vector `along` and the segment from p to q: in the
  // plane across the line both become a point and a segment.
  static double distance_to_segment(const dvec3& along, const dvec3& p, const dvec3& q) {
    const dvec3 flat_p = p - along * glm::dot(along, p);
    const dvec3 flat_q = q - along * glm::dot(along, q);
    const dvec3 way = flat_q - flat_p;
    const double square = glm::dot(way, way);
    const double s = square > 0.0 ? std::clamp(-glm::dot(flat_p, way) / square, 0.0, 1.0) : 0.0;
    return glm::length(flat_p + s * way);
  }

  static Meeting meet(const Ray& ray, const Triangle& triangle) {
    const dvec3 origin(ray.origin), direction(ray.direction);
    const dvec3 a = dvec3(triangle.a) - origin, b = dvec3(triangle.b) - origin,
                c = dvec3(triangle.c) - origin;
    const dvec3 normal = glm::cross(b - a, c - a);
    const double slope = glm::dot(direction, normal);
    Meeting meeting{};
    meeting.direction_length = glm::length(direction);
    meeting.reach = std::max({glm::length(a), glm::length(b), glm::length(c)});
    const double sharpness =
        std::abs(slope) / (meeting.direction_length * glm::length(b - a) * glm::length(c - a));
    meeting.blur =
        sharpness > 0.0 ? ROUNDING * meeting.reach / sharpness : std::numeric_limits<double>::infinity();
    meeting.t = glm::dot(a, normal) / slope;
    const dvec3 along = direction / meeting.direction_length;
    meeting.edge_distance = std::min({distance_to_segment(along, a, b), distance_to_segment(along, b, c),
                                      distance_to_segment(along, c, a)});
    // Of the point in the plane: on the inner side of each edge.
    const dvec3 point = direction * meeting.t;
    meeting.inside = glm::dot(glm::cross(b - a, point - a), normal) >= 0.0 &&
                     glm::dot(glm::cross(c - b, point - b), normal) >= 0.0 &&
                     glm::dot(glm::cross(a - c, point - c), normal) >= 0.0;
    return meeting;
  }

  std::span<const Triangle> triangles_;
};

// How many rays there are of each verdict.
struct Verdicts {
  std::size_t same = 0, ties = 0, borderline = 0, wrong = 0;
  std::size_t hits = 0;         // of `one`
  std::size_t first_wrong = 0;  // ray, where there is one

  std::size_t disputed() const { return ties + borderline + wrong; }
};

inline Verdicts judge_all(std::span<const Triangle> triangles, std::span<const Ray> rays,
                          std::span<const Hit> one, std::span<const Hit> other) {
  const HitReferee referee(triangles);
  Verdicts verdicts;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    verdicts.hits += one[i].triangle != NO_TRIANGLE;
    switch (referee.judge(rays[i], one[i], other[i])) {
      case Verdict::same:
        ++verdicts.same;
        break;
      case Verdict::tie:
        ++verdicts.ties;
        break;
      case Verdict::borderline:
        ++verdicts.borderline;
        break;
      case Verdict::wrong:
        if (verdicts.wrong++ == 0) verdicts.first_wrong = i;
    }
  }
  return verdicts;
}

}  // namespace coppice
