#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interface/trace.h"

namespace coppice {

// The oracle of the tracers: intersections in exact arithmetic. Every float is a rational number, so whether
// a line meets a triangle and which of two hits is closer are decided without rounding.
//
// The meaning of a ray and of a hit is that of interface/trace.h, taken literally: the line meets the closed
// triangle (its border is part of it), from either side, at a t with t_min <= t <= t_max; of equal t the
// smallest triangle index. A triangle without area or with a non-finite corner is never hit, nor one whose
// plane the ray lies in. Direction components that are denormal count as 0.

// Whether the ray can hit anything at all: nothing is NaN, origin and direction are finite, t_min <= t_max,
// and at least one direction component is neither 0 nor denormal.
bool can_hit(const Ray& ray);

// The direction with its denormal components replaced by 0.
vec3 direction_that_counts(const Ray& ray);

// Where the ray's line meets a closed triangle, in whatever direction from the origin.
struct ExactMeeting {
  bool meets = false;      // all else is 0 or false where it does not
  bool in_range = false;   // t_min <= t <= t_max, decided exactly
  bool on_border = false;  // on an edge or a corner
  double t = 0;            // in units of the direction's length; rounded correctly, as are u and v
  double u = 0, v = 0;     // barycentric coordinates of corners b and c, in [0, 1]
};

// Meets nothing where the triangle is inactive or the ray cannot hit (can_hit).
ExactMeeting exact_meeting(const Triangle& triangle, const Ray& ray);

// -1, 0 or 1 as the exact t of the first triangle is less than, equal to or greater than that of the second.
// Both must be met by the ray's line.
int compare_distances(const Triangle& first, const Triangle& second, const Ray& ray);

// Whether the corners are finite and the exact area is 0.
bool is_exactly_degenerate(const Triangle& triangle);

struct ExactHit {
  std::uint32_t triangle = NO_TRIANGLE;  // NO_TRIANGLE: the ray hits nothing
  ExactMeeting meeting;
};

// The closest hit, through a valid tree (find_fault names no fault) or, where `nodes` is empty, over all
// triangles. Boxes and triangles are first tried in double with error bounds, so that only what is close to
// the line or tied is computed exactly. (In a tree of split triangles the boxes of parts are rounded, and at
// the seam of two parts there is only a margin, BOX_ROOM of exact_walk.h.)
ExactHit closest_exact(std::span<const Node> nodes, std::span<const Triangle> triangles, const Ray& ray);

}  // namespace coppice
