#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "interface/trace.h"

namespace coppice {

// An independent scalar tracer, for comparison with that of the device. It computes in double, and asks a
// tree only which triangles to test, so closest_hit on a valid tree and brute_force_hit return the same bits
// (but for a tree of split triangles, where a hit on the seam of two parts may be lost to rounding).
//
// A hit is a triangle that the ray's line crosses, from either side, with t_min <= t <= t_max where t is the
// distance rounded to float and finite. The least t wins, of equal ones the smaller triangle index.
// Neighbours that share an edge leave no gap between them. A triangle without area, or seen exactly edge-on,
// is never hit, nor an inactive one. A miss has t = ray.t_max, triangle = NO_TRIANGLE and u = v = 0. A ray
// with a NaN, an infinite origin or direction, a reversed range, or a direction whose components are all 0 or
// denormal misses; a single denormal component counts as 0. t_max may be infinite.
//
// The triangle test is in Pluecker coordinates: Platis and Theoharis, "Fast Ray-Tetrahedron Intersection
// Using Pluecker Coordinates", 2003.

// Through a valid tree (find_fault names no fault) of any depth; a miss where `nodes` is empty.
Hit closest_hit(std::span<const Node> nodes, std::span<const Triangle> triangles, const Ray& ray);

// Tests every triangle.
Hit brute_force_hit(std::span<const Triangle> triangles, const Ray& ray);

// Whether ray number `ray` goes on as if it had not met this triangle there. Called by several threads.
using PassedHits = std::function<bool(std::size_t ray, const Hit& hit)>;

// hits[i] = the closest hit of rays[i] that it does not pass, in parallel; by brute force where `nodes` is
// empty. Throws std::invalid_argument where the spans differ in length.
void trace_all(std::span<const Node> nodes, std::span<const Triangle> triangles, std::span<const Ray> rays,
               std::span<Hit> hits, const PassedHits& passes = {});

}  // namespace coppice
