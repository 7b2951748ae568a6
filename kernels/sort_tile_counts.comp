// In:  keys. Out: how often each digit of this pass occurs in each tile. Only for sorting without lookback.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { SortPassArgs args; };

#include "lib/sort_tile.glsl"

void main() {
  uint tile = gl_WorkGroupID.x;
  count_rows(tile);
  [[dont_unroll]] for (uint digit = gl_LocalInvocationIndex; digit < SORT_DIGITS; digit += SORT_GROUP)
    args.tile_status.at[tile * SORT_DIGITS + digit] = sum_of_rows(digit);
}
