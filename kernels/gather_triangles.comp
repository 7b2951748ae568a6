// In:  vertices, with or without indices and a transform. Out: triangles by their corners, as all other stages read them.
// Coordinates that are denormal or -0 become +0, as those of scene files do: what every device computes alike. A
// triangle with an index out of range or a corner that is not finite is inactive: all NaN, of the same bits everywhere.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/gather.h"
#include "lib/device_count.glsl"
#include "lib/subgroup_run.glsl"
#include "lib/transform.glsl"

layout(local_size_x = GATHER_TRIANGLES_GROUP) in;
layout(push_constant, scalar) uniform Push { GatherTrianglesArgs args; };

vec4 load_row(uint row) {
  UintBuffer words = UintBuffer(uint64_t(args.transform) + row * 16u);
  return uintBitsToFloat(uvec4(words.at[0], words.at[1], words.at[2], words.at[3]));
}

// Whatever, if it is null.
Transform load_transform() {
  Transform transform;
  if (uint64_t(args.transform) != 0ul)
    [[unroll]] for (uint row = 0u; row < 3u; ++row) transform.rows[row] = flushed_row(load_row(row));
  return transform;
}

// Indices of 16 bits come in words that hold two, of which the first or the last may be another's.
uint index_of(uint corner) {
  if (uint64_t(args.indices) == 0ul) return corner;
  uint64_t at = uint64_t(args.indices) + uint64_t(corner) * args.index_bytes;
  uint word = UintBuffer(at & ~3ul).at[0];
  return args.index_bytes == 4u ? word : bitfieldExtract(word, int(uint(at) & 2u) * 8, 16);
}

vec3 inactive_corner() { return vec3(uintBitsToFloat(GATHERED_INACTIVE)); }

vec3 load_corner(uint corner, Transform transform) {
  uint index = index_of(corner), vertex = args.first_vertex + index;
  if (vertex < index || vertex >= args.vertex_count) return inactive_corner();
  UintBuffer words = UintBuffer(uint64_t(args.vertices) + uint64_t(vertex) * args.vertex_stride);
  vec3 position = flushed(uintBitsToFloat(uvec3(words.at[0], words.at[1], words.at[2])));
  if (uint64_t(args.transform) == 0ul) return position;
  return transformed(transform, position);
}

void main() {
  uint count = counted(args.count_at, args.triangle_count);
  if (gl_WorkGroupID.x * GATHER_TRIANGLES_TILE >= count) return;
  Transform transform = load_transform();
  Run run = subgroup_run(gl_WorkGroupID.x * GATHER_TRIANGLES_TILE, GATHER_TRIANGLES_PER_INVOCATION, count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    Triangle t = Triangle(load_corner(3u * i, transform), load_corner(3u * i + 1u, transform),
                          load_corner(3u * i + 2u, transform));
    if (!(finite(t.a) && finite(t.b) && finite(t.c)))
      t = Triangle(inactive_corner(), inactive_corner(), inactive_corner());
    args.triangles.at[i] = t;
  }
}
