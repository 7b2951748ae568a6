// Triangles that let rays through in places: what images, or one number, say of how much of a surface is
// there.
#ifndef COPPICE_INTERFACE_ALPHA_H
#define COPPICE_INTERFACE_ALPHA_H
#include "texture.h"
#include "trace.h"
INTERFACE_BEGIN

// How much is there, in 255 parts: a byte a texel, bilinear in between, without mip levels.
struct AlphaMap {
  uint first_texel;    // of the bytes of all maps; the first is the lowest of its word, rows go from the top
                       // down
  uint width, height;  // from 1 to MAX_TEXTURE_SIDE
  uint flags;          // how it wraps, as in TextureHeader
  vec2 scale, offset;  // as in TextureHeader
  float threshold;     // nothing is there below it; of coverage, below a random number times it
  uint is_coverage;    // 0 or 1
  uint padding0, padding1;
};

// AlphaTriangle::map of those that need no map.
const uint ALPHA_SOLID = 0xffffffffu;
const uint ALPHA_NOTHING = 0xfffffffeu;

struct AlphaTriangle {
  vec2 texcoord_a, texcoord_b, texcoord_c;  // of its corners
  uint map;
  uint padding;
};

INTERFACE_BUFFER(AlphaMapBuffer, AlphaMap, 16)
INTERFACE_BUFFER(AlphaTriangleBuffer, AlphaTriangle, 16)

// What follows is as the arguments of the same name without Alpha, of triangles that rays pass where nothing
// is there: the closest hit is the closest one on something, and any hit is one on something. Whether
// coverage lets a ray through depends on the bits of its origin and its direction, and on the triangle,
// alone: a hash of them (kernels/lib/alpha.glsl) is the random number.

struct TraceClosestAlphaArgs {
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  HitBuffer hits;
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  UintBuffer ray_steps;
  READS(AlphaTriangleBuffer) alpha_triangles;  // one a triangle
  READS(AlphaMapBuffer) alpha_maps;
  READS(UintBuffer) alpha_texels;
  uint ray_count;
  uint ray_mask;
  uint stack_entries;
  uint triangle_test;
  uint box_test;
  uint padding;
};

struct TraceWideAlphaArgs {
  READS(WideNodeBuffer) wide_nodes;
  READS(WideCountsBuffer) wide_counts;
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  HitBuffer hits;
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  UintBuffer ray_steps;
  READS(AlphaTriangleBuffer) alpha_triangles;
  READS(AlphaMapBuffer) alpha_maps;
  READS(UintBuffer) alpha_texels;
  uint ray_count;
  uint ray_mask;
};

struct TraceAnyAlphaArgs {
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  UintBuffer any_hits;
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  READS(AlphaTriangleBuffer) alpha_triangles;
  READS(AlphaMapBuffer) alpha_maps;
  READS(UintBuffer) alpha_texels;
  uint ray_count;
  uint ray_mask;
  uint stack_entries;
  uint triangle_test;
  uint box_test;
  uint padding;
};

struct TraceWideAnyAlphaArgs {
  READS(WideNodeBuffer) wide_nodes;
  READS(WideCountsBuffer) wide_counts;
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  UintBuffer any_hits;
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  READS(AlphaTriangleBuffer) alpha_triangles;
  READS(AlphaMapBuffer) alpha_maps;
  READS(UintBuffer) alpha_texels;
  uint ray_count;
  uint ray_mask;
};

INTERFACE_END
#endif
