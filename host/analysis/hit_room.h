#pragma once

#include <glm/ext/vector_double3.hpp>

#include "analysis/exact_walk.h"

namespace coppice {

// How well a hit of a triangle is defined in single precision: the quantities of judge_hits.h, in double.
class HitRoom {
 public:
  // The triangle is active and has an area.
  HitRoom(const ExactLine& line, const Triangle& triangle);

  // All t that may be reported for the triangle.
  Interval distances() const;

  // Whether the reported t and (u, v) are near where the line meets the triangle's plane.
  bool admits_distance(double t) const;
  bool admits_coordinates(double u, double v) const;

  double reach;   // largest |corner - origin|, maximum norm
  double delta;   // the room for rounding, a length
  double gap;     // from the line to the triangle
  double border;  // from the line to its nearest edge
  double length;  // of the direction

 private:
  double room() const;

  glm::dvec3 along_;               // unit direction
  glm::dvec3 a_, to_b_, to_c_;     // a from the origin, and two edges
  glm::dvec3 normal_;              // unit
  double slope_;                   // |cosine| between the direction and the normal
  double sliver_;                  // longest edge squared / twice the area, at least 1
  double plane_depth_;             // where the line meets the plane; 0 where it never does
  double low_depth_, high_depth_;  // of the corners, widened by delta
};

}  // namespace coppice
