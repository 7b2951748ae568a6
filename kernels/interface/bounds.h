#ifndef COPPICE_INTERFACE_BOUNDS_H
#define COPPICE_INTERFACE_BOUNDS_H
#include "types.h"
INTERFACE_BEGIN

const uint PRIMITIVE_BOUNDS_GROUP = 64;
const uint PRIMITIVE_BOUNDS_PER_INVOCATION = 16;
const uint PRIMITIVE_BOUNDS_TILE = PRIMITIVE_BOUNDS_GROUP * PRIMITIVE_BOUNDS_PER_INVOCATION;

struct PrimitiveBoundsArgs {
  READS(TriangleBuffer) triangles;  // triangle_count
  AabbBuffer boxes;                 // triangle_count; an inactive triangle's box has box_min > box_max
  BuildStateBuffer state;
  READS(UintBuffer) count_at;  // null, or how many of them count
  uint triangle_count;
  uint padding;
};

// Of boxes that only the caller knows what they hold, in workgroups as those of primitive_bounds.
struct BoxBoundsArgs {
  READS(UintBuffer) given;  // box_count: an Aabb at the start of each `stride` bytes, a multiple of 4
  AabbBuffer boxes;         // box_count; an inactive one has box_min > box_max
  BuildStateBuffer state;
  READS(UintBuffer) count_at;  // null, or how many of them count
  uint box_count;
  uint stride;
};

INTERFACE_END
#endif
