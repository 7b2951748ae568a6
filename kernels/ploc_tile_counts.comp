// In:  the clusters of a round. Out: whom each merges with; how many clusters of each tile retire and merge. Only for
// merging without lookback.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 3) const uint RADIUS = 8u;
layout(push_constant, scalar) uniform Push { PlocMergeArgs args; };

#include "lib/node_words.glsl"
#include "lib/ploc_tile.glsl"

Node load_cluster(uint i) { return load_node(args.clusters_in, i); }
void keep_partner(uint i, uint partner) { args.partners.at[i] = partner; }
Normalisation tree_normalisation() { return scene_normalisation(args.state.at[0]); }

void main() {
  uvec2 total = find_partners(gl_WorkGroupID.x, args.rounds.at[args.round], true);
  if (gl_LocalInvocationIndex < PLOC_MERGE_SUMS)
    args.tile_status.at[gl_WorkGroupID.x * PLOC_MERGE_SUMS + gl_LocalInvocationIndex] = total[gl_LocalInvocationIndex];
}
