// The children of a wide node that one ray meets, nearest first.
// Distances may be fused or not: their room is for the roundings of both, and no bit of them reaches a hit.
#ifndef COPPICE_LIB_WIDE_KEYS
#define COPPICE_LIB_WIDE_KEYS
#include "grid_ray.glsl"
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer WideWordsBuffer { u64vec4 at[]; };

const uint NO_KEY = 0x7fffffffu;

int plane_distance(uint bytes, uint shift, float scale, float start) {
  return floatBitsToInt(fma(float(int((bytes >> shift) & 0xffu)), scale, start));
}

// Where the ray enters the box and, in the three lowest bits, the child; NO_KEY for a box that it misses up to `limit`.
// The lowest three bytes of `low` and `high` are the box' planes.
uint child_key(GridRay grid, uint low, uint high, uint child, vec3 scale, vec3 near_start, vec3 far_start, int limit) {
  uint swapped = (low ^ high) & grid.backward;
  uint near = low ^ swapped, far = high ^ swapped;
  int enter = max(max(plane_distance(near, 0u, scale.x, near_start.x), plane_distance(near, 8u, scale.y, near_start.y)),
                  max(plane_distance(near, 16u, scale.z, near_start.z), grid.first));
  int leave = min(min(plane_distance(far, 0u, scale.x, far_start.x), plane_distance(far, 8u, scale.y, far_start.y)),
                  min(plane_distance(far, 16u, scale.z, far_start.z), limit));
  return enter <= leave ? (uint(enter) & ~(WIDE_CHILDREN - 1u)) | child : NO_KEY;
}

void put_in_order(inout uint a, inout uint b) {
  uint lower = min(a, b), higher = max(a, b);
  a = lower;
  b = higher;
}

// Batcher's network, 19 comparisons; by minimum and maximum of integers, one instruction each on CPU devices.
void sort_keys(inout uint key[WIDE_CHILDREN]) {
  [[unroll]] for (uint k = 0u; k < 4u; ++k) put_in_order(key[k + (k & 2u)], key[k + (k & 2u) + 2u]);
  [[unroll]] for (uint k = 0u; k < 4u; ++k) put_in_order(key[k], key[k + 4u]);
  [[unroll]] for (uint k = 0u; k < 8u; k += 2u) put_in_order(key[k], key[k + 1u]);
  [[unroll]] for (uint k = 2u; k < 4u; ++k) put_in_order(key[k], key[k + 2u]);
  [[unroll]] for (uint k = 1u; k < 5u; k += 2u) put_in_order(key[k], key[k + 3u]);
  [[unroll]] for (uint k = 1u; k < 7u; k += 2u) put_in_order(key[k], key[k + 1u]);
}

// Header and planes of a node.
struct NodeWords {
  u64vec4 low, high;
};

NodeWords load_node_words(WideNodeBuffer nodes, uint node) {
  WideWordsBuffer words = WideWordsBuffer(nodes);
  return NodeWords(words.at[node * 3u], words.at[node * 3u + 1u]);
}

void find_keys(GridRay grid, NodeWords words, int limit, out uint key[WIDE_CHILDREN]) {
  u64vec4 low = words.low, high = words.high;
  uvec2 origin_xy = unpackUint2x32(low.x), origin_z = unpackUint2x32(low.y);
  uint e = origin_z.y;
  uvec3 cell_bits = uvec3(e << 23, e << 15, e << 7) & 0x7f800000u;
  vec3 cell = uintBitsToFloat(cell_bits);
  precise vec3 scale = cell * grid.inverse;
  precise vec3 to_origin = uintBitsToFloat(uvec3(origin_xy, origin_z.x)) - grid.origin;
  vec3 start = fma(to_origin, grid.inverse, vec3(grid.offset));
  float largest_cell = uintBitsToFloat(max(max(cell_bits.x, cell_bits.y), cell_bits.z));
  precise float reach = largest(to_origin, to_origin) + largest_cell * WIDE_NODE_STEPS;
  vec3 pad = fma(grid.room, vec3(reach), grid.fixed_room);
  precise vec3 near_start = start - pad;
  precise vec3 far_start = start + pad;
  uvec2 planes[6] = uvec2[6](unpackUint2x32(low.z), unpackUint2x32(low.w), unpackUint2x32(high.x),
                             unpackUint2x32(high.y), unpackUint2x32(high.z), unpackUint2x32(high.w));
  [[unroll]] for (uint pair = 0u; pair < WIDE_CHILDREN / 2u; ++pair) {
    uint first = 3u * pair;
    uint a = planes[first / 2u][first & 1u], b = planes[(first + 1u) / 2u][(first + 1u) & 1u],
         c = planes[(first + 2u) / 2u][first & 1u];
    key[2u * pair] = child_key(grid, a, a >> 24 | b << 8, 2u * pair, scale, near_start, far_start, limit);
    key[2u * pair + 1u] =
        child_key(grid, b >> 16 | c << 16, c >> 8, 2u * pair + 1u, scale, near_start, far_start, limit);
  }
}

#endif
