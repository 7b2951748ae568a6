#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "interface/trace.h"

namespace coppice {

// Judges the hits that a tracer in single precision reported, against exact arithmetic (exact_hit.h).
//
// An intersection test in fp32 cannot be exact; a good one gives an answer that is exact for a triangle whose
// corners are moved a little. The room for that, in units of length, is
//   delta = 2^-18 * the largest |corner - origin| of the triangle (maximum norm), 64 roundings of that
//   distance.
// Further quantities of a ray and a triangle, all computed in double, whose rounding is far below delta:
//   gap       distance from the ray's line to the triangle; 0 where it passes through
//   border    distance from the line to the nearest edge, as a segment
//   sliver    longest edge squared / twice the area, at least 1: an edge function is a difference of products
//             as large as the edges squared, so all that is divided by the area loses accuracy by this factor
//   slope     |cosine| of the angle between the direction and the triangle's normal
//   depths    the least and greatest depth of the corners along the ray, widened by delta
//   room      delta * sliver / slope, along the ray: moving the plane by delta * sliver moves the line's
//             meeting with it by that. Unbounded as the ray grazes the plane; but no hit is outside of
//             depths.
// Depths become t by division by the direction's length. All bounds on t are widened by 2^-126, since a
// denormal t may be flushed to 0.
//
// A reported hit is FALSE
//   - on a bad index, an inactive triangle, or one with two equal corners;
//   - of a ray that hits nothing (can_hit);
//   - if its t is not finite or not in [t_min, t_max];
//   - if gap > delta;
//   - if the point origin + t * direction is farther than delta * sliver from the triangle's plane, or its
//     depth is outside of depths. (Its distance from the triangle would be unsound: where the ray grazes the
//     plane, a t that is off by little across the plane slides far along it.)
//   - if u or v is not in [0, 1] or u + v > 1 + 2^-20, or the point at (u, v) is farther than 2 * room +
//   delta
//     from the line's meeting with the plane.
// A triangle whose area is exactly 0, or whose sliver is above 2^40 so that double does not tell its plane,
// is a segment: rounding may give it an area, and around it the mesh has a gap of that size, which its hit
// closes. Such a hit is false unless the point at (u, v) is within 2 * delta of the line and its depth within
// 2 * delta of that of t (docs/numerics.md, "Triangle test").
// A ray that lies in a plane exactly is not told apart from one that lies in it nearly: after rounding
// corner - origin no test could, so a hit there is no false one if it keeps the rest.
//
// A triangle is a CLEAR hit if the line meets it with border > delta, which means that the line still meets
// it wherever its corners are moved by up to delta (the winding number of its outline, seen along the ray,
// cannot change unless the outline crosses the line), and if all t that may be reported for it, [exact t -
// room, exact t + room] within depths, are within [t_min, t_max] and finite as floats.
//
// A ray is MISSED if a triangle is a clear hit, and no hit or a false one is reported or one whose t is
// greater than all that may be reported for that triangle. Rays whose exact hits lie within the room of an
// end of the range may go either way. Where rays go from inside of a closed mesh with t_max = infinity,
// missed + missed_at_edges are the leaks.
struct HitVerdicts {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;        // reported
  std::uint64_t exact_hits = 0;  // rays that hit something in exact arithmetic
  std::uint64_t missed = 0;
  // No clear hit is missed, but there is an exact hit whose t is clearly within the range and which lies
  // within delta of the border, and: nothing (or a false hit) is reported / something behind all t that may
  // be reported for it. The latter is right at a silhouette and a leak at a seam.
  std::uint64_t missed_at_edges = 0;
  std::uint64_t behind_edges = 0;
  std::uint64_t false_hits = 0;
  std::uint64_t false_on_degenerate = 0;  // of these: on a triangle whose exact area is 0
  std::uint64_t other_triangle = 0;       // right, but not the exact closest one: ties, edges, rounding

  // Over the hits that are neither false nor of a missed ray and that are on a triangle which is a clear hit.
  // (Of others the errors say nothing: near an end of the range the exact t may be 0, near the border or in a
  // grazed plane it may be anything.)
  double worst_t_ulps = 0;    // in units in the last place of the exact t as a float
  double worst_t_scaled = 0;  // error of the depth in units of 2^-24 * largest |corner - origin|
  double worst_uv_ulps = 0;   // absolute error of u or v in units of 2^-24

  // Indices of rays, the first or worst of each; NO_RAY where there is none.
  static constexpr std::uint64_t NO_RAY = ~std::uint64_t{0};
  std::uint64_t example_missed = NO_RAY;
  std::uint64_t example_missed_at_edges = NO_RAY;
  std::uint64_t example_false = NO_RAY;
  std::uint64_t example_t = NO_RAY;  // of worst_t_ulps
  std::uint64_t example_uv = NO_RAY;

  // Adds counts and keeps the worst; of examples the first, so both must number rays alike for those to mean
  // anything.
  HitVerdicts& operator+=(const HitVerdicts& other);
};

// hits[i] is what was reported for rays[i]; a miss has triangle = NO_TRIANGLE, its other members are not
// read. `nodes` is a valid tree over the triangles, any builder's, or empty (then every ray takes the time of
// all triangles). In parallel; the result does not depend on the threads. Throws std::invalid_argument where
// rays and hits differ in length.
HitVerdicts judge_hits(std::span<const Node> nodes, std::span<const Triangle> triangles,
                       std::span<const Ray> rays, std::span<const Hit> hits);

// Why a reported hit is false by the list above, as a phrase; empty where it is not.
std::string_view why_false(std::span<const Triangle> triangles, const Ray& ray, const Hit& hit);

}  // namespace coppice
