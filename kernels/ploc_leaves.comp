// In:  boxes and the Morton order of the triangles. Out: one cluster an active triangle, in that order; round 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"
#include "lib/node_words.glsl"

layout(local_size_x = PLOC_LEAVES_GROUP) in;
layout(push_constant, scalar) uniform Push { PlocLeavesArgs args; };

void main() {
  uint active_count = args.state.at[0].active_count;
  if (gl_GlobalInvocationID.x == 0u) args.rounds.at[0] = planned_round(active_count, 0u, false);
  uint first = gl_WorkGroupID.x * PLOC_LEAVES_TILE + gl_LocalInvocationIndex;
  uint last = min((gl_WorkGroupID.x + 1u) * PLOC_LEAVES_TILE, active_count);
  [[dont_unroll]] for (uint i = first; i < last; i += PLOC_LEAVES_GROUP) {
    uint triangle = args.values.at[i];
    Aabb box = load_box(args.boxes, triangle);
    store_node(args.clusters, i, Node(box.box_min, triangle, box.box_max, 0u));
  }
}
