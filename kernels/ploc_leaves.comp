// In:  boxes and the Morton order of the triangles. Out: one cluster an active triangle, in that order; round 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"
#include "lib/subgroup_run.glsl"

layout(local_size_x = PLOC_LEAVES_GROUP) in;
layout(push_constant, scalar) uniform Push { PlocLeavesArgs args; };

#include "lib/leaf_nodes.glsl"

void main() {
  uint active_count = args.state.at[0].active_count;
  if (gl_GlobalInvocationID.x == 0u) args.rounds.at[0] = planned_round(active_count, 0u, false);
  Run run = subgroup_run(gl_WorkGroupID.x * PLOC_LEAVES_TILE, PLOC_LEAVES_PER_INVOCATION, active_count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LEAVES_AHEAD * LANES) {
    Node leaves[LEAVES_AHEAD];
    load_leaves(i, run.last, leaves);
    [[unroll]] for (uint k = 0u; k < LEAVES_AHEAD; ++k)
      if (i + k * LANES < run.last) store_node(args.clusters, i + k * LANES, leaves[k]);
  }
}
