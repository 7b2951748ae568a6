// In:  digit counts of the tiles. Out: where the first key of each tile and digit goes: the exclusive sums over all
// tiles of digit 0, all tiles of digit 1, and so on. One workgroup; an invocation walks over the tiles for a digit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"
#include "lib/device_count.glsl"

layout(local_size_x = SORT_TILE_SCAN_GROUP) in;
layout(constant_id = 0) const uint DIGIT_BITS = SORT_NARROW_BITS;  // args.digit_bits
layout(push_constant, scalar) uniform Push { SortTileScanArgs args; };

const uint DIGITS = 1u << DIGIT_BITS;

shared uint sums[DIGITS];

void sum_tiles(uint digit, uint tile_count) {
  uint sum = 0u;
  [[dont_unroll]] for (uint tile = 0u; tile < tile_count; ++tile)
    sum += args.tile_digits.at[tile * DIGITS + digit];
  sums[digit] = sum;
}

// One subgroup.
void scan_digits() {
  uint before = 0u;
  [[dont_unroll]] for (uint first = 0u; first < DIGITS; first += gl_SubgroupSize) {
    uint digit = first + gl_SubgroupInvocationID;
    uint sum = sums[digit];
    sums[digit] = before + subgroupExclusiveAdd(sum);
    before += subgroupAdd(sum);
  }
}

void place_tiles(uint digit, uint tile_count) {
  uint place = sums[digit];
  [[dont_unroll]] for (uint tile = 0u; tile < tile_count; ++tile) {
    uint i = tile * DIGITS + digit;
    uint keys = args.tile_digits.at[i];
    args.tile_digits.at[i] = place;
    place += keys;
  }
}

void main() {
  uint first = gl_LocalInvocationIndex;
  uint tile_count = (counted(args.count_at, args.count) + args.tile_keys - 1u) / args.tile_keys;
  [[dont_unroll]] for (uint digit = first; digit < DIGITS; digit += SORT_TILE_SCAN_GROUP) sum_tiles(digit, tile_count);
  barrier();
  if (gl_SubgroupID == 0u) scan_digits();
  barrier();
  [[dont_unroll]] for (uint digit = first; digit < DIGITS; digit += SORT_TILE_SCAN_GROUP) place_tiles(digit, tile_count);
}
