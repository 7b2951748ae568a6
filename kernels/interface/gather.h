// Triangles as others keep them: vertices at a stride, with or without indices and a transform.
#ifndef COPPICE_INTERFACE_GATHER_H
#define COPPICE_INTERFACE_GATHER_H
#include "types.h"
INTERFACE_BEGIN

const uint GATHER_TRIANGLES_GROUP = 64;
const uint GATHER_TRIANGLES_PER_INVOCATION = 16;
const uint GATHER_TRIANGLES_TILE = GATHER_TRIANGLES_GROUP * GATHER_TRIANGLES_PER_INVOCATION;

// All bits of each coordinate of an inactive triangle: a quiet NaN.
const uint GATHERED_INACTIVE = 0x7fc00000u;

struct GatherTrianglesArgs {
  READS(UintBuffer) vertices;  // vertex_count: three floats at the start of each vertex_stride bytes
  READS(UintBuffer)
  indices;  // 3 * triangle_count, index_bytes each; null: corner k of triangle i is vertex 3 i + k
  READS(UintBuffer) transform;  // three rows of four floats; null: none
  TriangleBuffer triangles;     // triangle_count
  READS(UintBuffer) count_at;   // null, or how many of them count
  uint triangle_count;
  uint vertex_count;
  uint vertex_stride;  // bytes: a multiple of 4, at least 12
  uint first_vertex;   // added to each index
  uint index_bytes;    // 4, at an address that is a multiple of 4; or 2, at one of 2
  uint padding;
};

INTERFACE_END
#endif
