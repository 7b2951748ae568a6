// In:  clusters in Morton order. Out: the index of each cluster's nearest neighbour within the search radius.
// Meister and Bittner 2018, section 3.2: boxes of a tile and its halo in shared memory. Also clears the lookback words
// of this round's merge.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#define PLOC_RUN PLOC_NEAREST_RUN
#define PLOC_TILE_BOXES (PLOC_NEAREST_TILE + 2 * PLOC_MAX_RADIUS)
#include "lib/ploc_round.glsl"
#include "lib/ploc_search.glsl"

layout(local_size_x = PLOC_NEAREST_GROUP) in;
layout(push_constant, scalar) uniform Push { PlocNearestArgs args; };

void clear_tile_status(uint cluster_count) {
  uint words = tiles(cluster_count, PLOC_MERGE_TILE) * PLOC_MERGE_SUMS;
  if (gl_GlobalInvocationID.x < words) args.tile_status.at[gl_GlobalInvocationID.x] = 0u;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint cluster_count = args.rounds.at[args.round].cluster_count;
  uint first = gl_WorkGroupID.x * PLOC_NEAREST_TILE;
  uint last = min(first + PLOC_NEAREST_TILE, cluster_count);
  clear_tile_status(cluster_count);
  if (args.rounds.at[args.round].pair_all != 0u) {
    [[dont_unroll]] for (uint i = first + lane; i < last; i += PLOC_NEAREST_GROUP)
      args.nearest.at[i] = paired_with(i, cluster_count);
    return;
  }

  Normalisation normalisation = scene_normalisation(args.state.at[0]);
  uint halo_first = first - min(first, args.radius);
  uint halo_last = min(last + args.radius, cluster_count);
  [[dont_unroll]] for (uint i = halo_first + lane; i < halo_last; i += PLOC_NEAREST_GROUP)
    cache_box(i - halo_first, args.clusters.at[i], normalisation);
  barrier();
  uint i = first + lane * PLOC_RUN;
  uint nearest[PLOC_RUN];
  find_nearest(i, i - halo_first, cluster_count, args.radius, nearest);
  [[unroll]] for (uint k = 0u; k < PLOC_RUN; ++k) {
    if (i + k < cluster_count) args.nearest.at[i + k] = nearest[k];
  }
}
