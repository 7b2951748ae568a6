// In:  sums of the tiles of a merge. Out: their exclusive sums over the tiles. Only for merging without lookback.
// One workgroup; each invocation sums a run of consecutive tiles, the runs are scanned in shared memory.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"

layout(local_size_x = PLOC_TILE_SCAN_GROUP) in;
layout(push_constant, scalar) uniform Push { PlocTileScanArgs args; };

shared uvec2 run_sums[PLOC_TILE_SCAN_GROUP];

uvec2 sums_of(uint tile) {
  return uvec2(args.tile_status.at[tile * PLOC_MERGE_SUMS], args.tile_status.at[tile * PLOC_MERGE_SUMS + 1u]);
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint tile_count = args.rounds.at[args.round].merge_groups.x;
  uint run = (tile_count + PLOC_TILE_SCAN_GROUP - 1u) / PLOC_TILE_SCAN_GROUP;
  uint first = min(lane * run, tile_count), last = min(first + run, tile_count);

  uvec2 sum = uvec2(0u);
  [[dont_unroll]] for (uint tile = first; tile < last; ++tile) sum += sums_of(tile);
  run_sums[lane] = sum;
  barrier();
  sum = uvec2(0u);
  [[dont_unroll]] for (uint before = 0u; before < lane; ++before) sum += run_sums[before];
  [[dont_unroll]] for (uint tile = first; tile < last; ++tile) {
    uvec2 tile_sum = sums_of(tile);
    args.tile_status.at[tile * PLOC_MERGE_SUMS] = sum.x;
    args.tile_status.at[tile * PLOC_MERGE_SUMS + 1u] = sum.y;
    sum += tile_sum;
  }
}
