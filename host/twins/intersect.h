#pragma once

#include "interface/trace.h"
#include "twins/trace_ray.h"

namespace coppice::twins {

// Slab test: false only if the ray misses the box for t in [ray.t_min, t_max]. `enter` is where it enters, at
// least t_min. With BOX_ROBUST slabs are wider, by ray.room for each unit that the farthest corner is away.
bool ray_meets_box(const TraceRay& ray, const vec3& box_min, const vec3& box_max, uint box_test, float t_max,
                   float& enter);

// The same with BOX_ROBUST for a box that is known to be within `reach` of the origin, in the maximum norm.
bool ray_meets_box_within(const TraceRay& ray, const vec3& box_min, const vec3& box_max, float reach,
                          float t_max, float& enter);

// Keeps the closer hit in `hit`, of equally close ones the one with the smaller index. TRIANGLE_FAST: Moller
// and Trumbore 1997; TRIANGLE_WATERTIGHT: Woop, Benthin and Wald 2013.
void ray_meets_triangle(const TraceRay& ray, const Triangle& triangle, uint index, uint triangle_test,
                        Hit& hit);

}  // namespace coppice::twins
