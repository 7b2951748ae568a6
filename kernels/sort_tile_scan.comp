// In:  digit counts of the tiles. Out: their exclusive sums over the tiles. Only for sorting without lookback.
// One invocation a digit walks over the tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"

layout(local_size_x = SORT_DIGITS) in;
layout(push_constant, scalar) uniform Push { SortTileScanArgs args; };

void main() {
  uint sum = 0u;
  [[dont_unroll]] for (uint tile = 0u; tile < args.tile_count; ++tile) {
    uint i = tile * SORT_DIGITS + gl_LocalInvocationIndex;
    uint tile_count = args.tile_status.at[i];
    args.tile_status.at[i] = sum;
    sum += tile_count;
  }
}
