// In:  the clusters of a round. Out: the clusters of the next round, in the same order; the nodes of the pairs that
// merged; the next round's counts.
// One dispatch a round, as in Benthin et al. 2022, "PLOC++: Parallel Locally-Ordered Clustering for Bounding Volume
// Hierarchy Construction Revisited". A subgroup takes a tile: it finds the nearest neighbours of the tile and of its
// surroundings, merges mutual ones, and compacts the rest by a prefix scan over the tiles, which also numbers the nodes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 3) const uint RADIUS = 8u;
layout(push_constant, scalar) uniform Push { PlocMergeArgs args; };

#include "lib/node_words.glsl"
#include "lib/ploc_tile.glsl"
#include "lib/ploc_place.glsl"
#define LOOKBACK_GROUP gl_WorkGroupSize.x
#define LOOKBACK_SUMS PLOC_MERGE_SUMS
void sum_tile(uint tile);
#include "lib/lookback.glsl"

shared uint ticket;

Node load_cluster(uint i) { return load_node(args.clusters_in, i); }
void store_cluster(uint place, Node cluster) { store_node(args.clusters_out, place, cluster); }
void keep_partner(uint i, uint partner) { args.partners.at[i] = partner; }
uint partner_of(uint i) { return args.partners.at[i]; }
void sync_clusters() {}
Normalisation tree_normalisation() { return scene_normalisation(args.state.at[0]); }
uint tree_active_count() { return args.state.at[0].active_count; }
void store_tree_node(uint i, Node node) { store_node(args.nodes, i, node); }

void publish_sums(uvec2 sums) {
  if (gl_LocalInvocationIndex < PLOC_MERGE_SUMS) tile_sums[gl_LocalInvocationIndex] = sums[gl_LocalInvocationIndex];
  barrier();
}

void sum_tile(uint tile) { publish_sums(find_partners(tile, args.rounds.at[args.round], false)); }

// Sums over all tiles before this one.
struct Prefix {
  uvec2 sums;
  uint fallbacks;  // tiles that had to be summed up; more than LOOKBACK_MAX_FALLBACKS: not known
};

Prefix find_tile_prefix(uint tile) {
  if (args.lookback == 0u)
    return Prefix(
        uvec2(args.tile_status.at[tile * PLOC_MERGE_SUMS], args.tile_status.at[tile * PLOC_MERGE_SUMS + 1u]), 0u);
  uint fallbacks = lookback(args.tile_status, tile);
  return Prefix(uvec2(lookback_prefix[0], lookback_prefix[1]), fallbacks);
}

uint own_tile() {
  if (args.lookback == 0u) return gl_WorkGroupID.x;
  // Partners: the workgroups of this round. The order of tickets is an order in which tiles have started.
  if (gl_LocalInvocationIndex == 0u) ticket = atomicAdd(args.rounds.at[args.round].ticket, 1u);
  barrier();
  return started_tile(ticket, gl_NumWorkGroups.x);
}

void main() {
  PlocRound round = args.rounds.at[args.round];
  uint tile = own_tile();
  if (gl_LocalInvocationIndex < PLOC_MERGE_SUMS)
    args.next_status.at[tile * PLOC_MERGE_SUMS + gl_LocalInvocationIndex] = 0u;
  uvec2 sums = args.lookback != 0u ? find_partners(tile, round, true) : uvec2(0u);
  publish_sums(sums);
  Prefix prefix = find_tile_prefix(tile);
  if (prefix.fallbacks > LOOKBACK_MAX_FALLBACKS) {
    if (gl_LocalInvocationIndex == 0u) atomicOr(args.state.at[0].error_word, ERROR_PLOC_LOOKBACK);
    return;
  }
  uvec2 merged = place_tile(tile, round, prefix.sums);
  if (tile + 1u == round.merge_groups.x && gl_LocalInvocationIndex == 0u)
    args.rounds.at[args.round + 1u] =
        round_after(args.round, round.cluster_count, round.merged_before, merged.x);
}
