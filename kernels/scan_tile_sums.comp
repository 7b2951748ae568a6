// In:  words. Out: the sum of each tile's. Only for scanning without lookback.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/scan.h"

layout(local_size_x = SCAN_GROUP) in;
layout(push_constant, scalar) uniform Push { ScanTileSumsArgs args; };

#include "lib/device_count.glsl"
#include "lib/scan_tile.glsl"

void main() {
  word_count = counted(args.count_at, args.word_count);
  if (gl_WorkGroupID.x * SCAN_TILE_WORDS >= word_count) return;
  sum_runs(gl_WorkGroupID.x);
  if (gl_LocalInvocationIndex == 0u) args.tile_sums.at[gl_WorkGroupID.x] = sum_of_runs(SCAN_GROUP);
}
