// In:  clusters and their nearest neighbours. Out: the clusters of the next round, in the same order; the nodes of the
// pairs that merged; the next round's counts.
// Meister and Bittner 2018, sections 3.3 and 3.4: mutual nearest neighbours merge, the rest is compacted by a prefix
// scan over the tiles. The scan also numbers the nodes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"

layout(local_size_x = PLOC_MERGE_GROUP) in;
layout(push_constant, scalar) uniform Push { PlocMergeArgs args; };

#include "lib/ploc_tile.glsl"
#define LOOKBACK_GROUP PLOC_MERGE_GROUP
#define LOOKBACK_SUMS PLOC_MERGE_SUMS
void sum_tile(uint tile);
#include "lib/lookback.glsl"

shared uint ticket;

void sum_tile(uint tile) {
  uvec2 total = sum_fates(find_fates(tile, args.rounds.at[args.round].cluster_count));
  if (gl_LocalInvocationIndex < PLOC_MERGE_SUMS) tile_sums[gl_LocalInvocationIndex] = total[gl_LocalInvocationIndex];
  barrier();
}

// Sums over all tiles before this one; false if they cannot be known.
bool find_tile_prefix(uint tile, out uvec2 prefix) {
  if (args.lookback == 0u) {
    prefix = uvec2(args.tile_status.at[tile * PLOC_MERGE_SUMS], args.tile_status.at[tile * PLOC_MERGE_SUMS + 1u]);
    return true;
  }
  uint fallbacks = lookback(args.tile_status, tile);
  prefix = uvec2(lookback_prefix[0], lookback_prefix[1]);
  return fallbacks <= LOOKBACK_MAX_FALLBACKS;
}

void place_cluster(uint i, bool merges, uint place, uint first_child) {
  Node cluster = args.clusters_in.at[i];
  if (merges) {
    Node partner = args.clusters_in.at[args.nearest.at[i]];
    args.nodes.at[first_child] = cluster;
    args.nodes.at[first_child + 1u] = partner;
    cluster = parent_of(cluster, partner, first_child);
  }
  args.clusters_out.at[place] = cluster;
}

void place_tile(uint tile, PlocRound round, Fates fates, uvec2 before) {
  uint active_count = args.state.at[0].active_count;
  uint i = first_cluster(tile);
  [[dont_unroll]] for (uint k = 0u; k < PLOC_MERGE_STEPS; ++k, i += gl_SubgroupSize) {
    bool retires = bitfieldExtract(fates.retiring, int(k), 1) != 0u;
    bool merges = bitfieldExtract(fates.merging, int(k), 1) != 0u;
    uint word = (retires ? 1u : 0u) | (merges ? 0x10000u : 0u);
    uint sums = subgroupInclusiveAdd(word);
    if (i < round.cluster_count && !retires) {
      uvec2 rank = before + uvec2((sums - word) & 0xffffu, (sums - word) >> 16);
      place_cluster(i, merges, i - rank.x, first_child_of(active_count, round.merged_before + rank.y));
    }
    uint step_sums = subgroupBroadcast(sums, gl_SubgroupSize - 1u);
    before += uvec2(step_sums & 0xffffu, step_sums >> 16);
  }
}

void main() {
  PlocRound round = args.rounds.at[args.round];
  uint tile = gl_WorkGroupID.x;
  if (args.lookback != 0u) {
    // Partners: the workgroups of this round. The order of tickets is an order in which tiles have started.
    if (gl_LocalInvocationIndex == 0u) ticket = atomicAdd(args.rounds.at[args.round].ticket, 1u);
    barrier();
    tile = started_tile(ticket, gl_NumWorkGroups.x);
  }
  Fates fates = find_fates(tile, round.cluster_count);
  uvec2 sums = sum_fates(fates);
  uvec2 before = sums_before();
  if (gl_LocalInvocationIndex < PLOC_MERGE_SUMS) tile_sums[gl_LocalInvocationIndex] = sums[gl_LocalInvocationIndex];
  barrier();
  uvec2 prefix;
  if (!find_tile_prefix(tile, prefix)) {
    if (gl_LocalInvocationIndex == 0u) atomicOr(args.state.at[0].error_word, ERROR_PLOC_LOOKBACK);
    return;
  }
  place_tile(tile, round, fates, prefix + before);
  if (tile + 1u == round.merge_groups.x && gl_LocalInvocationIndex == 0u)
    args.rounds.at[args.round + 1u] = round_after(args.round, round.cluster_count, round.merged_before, prefix.x + sums.x);
}
