// In:  the clusters of a round. Out: the clusters of the next round, in the same order; the nodes of the pairs that
// merged; the next round's counts.
// One dispatch a round, as in Benthin et al. 2022, "PLOC++: Parallel Locally-Ordered Clustering for Bounding Volume
// Hierarchy Construction Revisited". A subgroup takes a tile: it finds the nearest neighbours of the tile and of its
// surroundings, merges mutual ones, and compacts the rest by a prefix scan over the tiles, which also numbers the nodes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 3) const uint RADIUS = 8u;
layout(push_constant, scalar) uniform Push { PlocMergeArgs args; };

#include "lib/ploc_tile.glsl"
#define LOOKBACK_GROUP gl_WorkGroupSize.x
#define LOOKBACK_SUMS PLOC_MERGE_SUMS
void sum_tile(uint tile);
#include "lib/lookback.glsl"

shared uint ticket;

void publish_sums(uvec2 sums) {
  if (gl_LocalInvocationIndex < PLOC_MERGE_SUMS) tile_sums[gl_LocalInvocationIndex] = sums[gl_LocalInvocationIndex];
  barrier();
}

void sum_tile(uint tile) { publish_sums(find_partners(tile, args.rounds.at[args.round], false)); }

// subgroupInclusiveAdd goes lane by lane on CPU devices.
uint inclusive_add(uint value) {
  [[unroll]] for (uint distance = 1u; distance < LANES; distance <<= 1) {
    uint before = subgroupShuffle(value, (lane() - distance) % LANES);
    value += lane() >= distance ? before : 0u;
  }
  return value;
}

void place_cluster(uint i, uint partner_index, uint place, uint first_child) {
  Node cluster = load_node(args.clusters_in, i);
  if (partner_index != i) {
    Node partner = load_node(args.clusters_in, partner_index);
    store_node(args.nodes, first_child, cluster);
    store_node(args.nodes, first_child + 1u, partner);
    cluster = parent_of(cluster, partner, first_child);
  }
  store_node(args.clusters_out, place, cluster);
}

// Returns the sums up to and with this tile.
uvec2 place_tile(uint tile, PlocRound round, uvec2 before) {
  uint active_count = args.state.at[0].active_count;
  uint first = tile * PLOC_MERGE_TILE;
  uint count = min(round.cluster_count - first, PLOC_MERGE_TILE);
  [[dont_unroll]] for (uint at = 0u; at < count; at += LANES) {
    uint i = first + at + lane();
    bool present = at + lane() < count;
    uint partner = present ? args.partners.at[i] : i;
    bool retires = partner == PLOC_RETIRES;
    uint word = retires ? 1u : partner != i ? 0x10000u : 0u;
    uint sums = inclusive_add(word);
    uvec2 rank = before + uvec2((sums - word) & 0xffffu, (sums - word) >> 16);
    if (present && !retires)
      place_cluster(i, partner, i - rank.x, first_child_of(active_count, round.merged_before + rank.y));
    uint block_sums = subgroupBroadcast(sums, LANES - 1u);
    before += uvec2(block_sums & 0xffffu, block_sums >> 16);
  }
  return before;
}

// Sums over all tiles before this one.
struct Prefix {
  uvec2 sums;
  uint fallbacks;  // tiles that had to be summed up; more than LOOKBACK_MAX_FALLBACKS: not known
};

Prefix find_tile_prefix(uint tile) {
  if (args.lookback == 0u)
    return Prefix(uvec2(args.tile_status.at[tile * PLOC_MERGE_SUMS], args.tile_status.at[tile * PLOC_MERGE_SUMS + 1u]), 0u);
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
