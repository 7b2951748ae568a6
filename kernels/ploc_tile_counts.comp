// In:  nearest neighbours. Out: how many clusters of each tile retire and merge. Only for merging without lookback.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"

layout(local_size_x = PLOC_MERGE_GROUP) in;
layout(push_constant, scalar) uniform Push { PlocMergeArgs args; };

#include "lib/ploc_tile.glsl"

void main() {
  uvec2 total = sum_fates(find_fates(gl_WorkGroupID.x, args.rounds.at[args.round].cluster_count));
  if (gl_LocalInvocationIndex < PLOC_MERGE_SUMS)
    args.tile_status.at[gl_WorkGroupID.x * PLOC_MERGE_SUMS + gl_LocalInvocationIndex] = total[gl_LocalInvocationIndex];
}
