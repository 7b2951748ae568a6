#pragma once

#include <glm/ext/vector_double3.hpp>

#include "analysis/exact_walk.h"

namespace coppice {

// How well a hit of a triangle is defined in single precision: the quantities of judge_hits.h, in double.
class HitRoom {
 public:
  // The triangle is active.
  HitRoom(const ExactLine& line, const Triangle& triangle);

  // Whether the triangle is a segment as far as double can tell. Then only admits_on_segment says something.
  bool is_segment() const { return !(sliver_ <= LARGEST_SLIVER); }

  // All t that may be reported for the triangle.
  Interval distances() const;

  // Whether the reported t and (u, v) are near where the line meets the triangle's plane.
  bool admits_distance(double t) const;
  bool admits_coordinates(double u, double v) const;

  // Whether the point at (u, v) is where the ray passes, and t is its distance.
  bool admits_on_segment(const Hit& hit) const;

  double reach;   // largest |corner - origin|, maximum norm
  double delta;   // the room for rounding, a length
  double gap;     // from the line to the triangle
  double border;  // from the line to its nearest edge
  double length;  // of the direction

 private:
  static constexpr double LARGEST_SLIVER = 0x1p40;

  double room() const;

  glm::dvec3 along_;            // unit direction
  glm::dvec3 a_, to_b_, to_c_;  // a from the origin, and two edges
  glm::dvec3 normal_;           // unit
  double slope_;                // |cosine| between the direction and the normal
  double sliver_;       // longest edge squared / twice the area, at least 1; infinite or NaN without one
  double plane_depth_;  // where the line meets the plane; 0 where it never does
  double low_depth_, high_depth_;  // of the corners, widened by delta
};

}  // namespace coppice
