// In:  the last clusters, at most PLOC_FINISH_CLUSTERS. Out: the rest of the nodes with the root at 0, the rest of the
// rounds, their number. One workgroup does all rounds in shared memory, by the same rules and with the same numbering
// as ploc_merge; one invocation holds one cluster.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#define PLOC_BOXES PLOC_FINISH_CLUSTERS
#include "lib/ploc_round.glsl"
#include "lib/ploc_search.glsl"

layout(local_size_x = PLOC_FINISH_CLUSTERS) in;
layout(push_constant, scalar) uniform Push { PlocFinishArgs args; };

shared Node clusters[PLOC_FINISH_CLUSTERS];
shared uint nearest[PLOC_FINISH_CLUSTERS];
shared uint subgroup_sums[PLOC_FINISH_CLUSTERS / 4];  // no device has subgroups of fewer than 4

uint first_finish_round() {
  uint round = 0u;
  [[dont_unroll]] while (round < args.rounds_bound && args.rounds.at[round].merge_groups.x != 0u) ++round;
  return round;
}

void find_neighbours(uint i, uint cluster_count, bool pair_all, Normalisation normalisation) {
  if (i < cluster_count) cache_box(i, clusters[i], normalisation);
  barrier();
  if (i < cluster_count) {
    if (pair_all) nearest[i] = paired_with(i, cluster_count);
    else nearest[i] = find_nearest(i, cluster_count, min(args.radius, cluster_count - 1u));
  }
  barrier();
}

// Exclusive and total sums over the workgroup of two 16-bit counters a word.
uvec2 scan_workgroup(uint word, uint cluster_count) {
  uint before = subgroupExclusiveAdd(word);
  uint sum = subgroupAdd(word);
  if (subgroupElect()) subgroup_sums[gl_SubgroupID] = sum;
  barrier();
  uint total = 0u;
  uint last = (cluster_count + gl_SubgroupSize - 1u) / gl_SubgroupSize;  // the others hold no cluster
  [[dont_unroll]] for (uint s = 0u; s < last; ++s) {
    if (s == gl_SubgroupID) before += total;
    total += subgroup_sums[s];
  }
  barrier();
  return uvec2(before, total);
}

// Returns how many pairs merged.
uint merge(uint i, uint cluster_count, uint merged_before, uint active_count) {
  bool present = i < cluster_count;
  uint j = present ? nearest[i] : 0u;
  bool mutual = present && j != i && nearest[j] == i;
  bool retires = mutual && j < i, merges = mutual && i < j;
  uvec2 scanned = scan_workgroup((merges ? 0x10000u : 0u) | (retires ? 1u : 0u), cluster_count);

  Node cluster;
  if (present) cluster = clusters[i];
  if (merges) {
    uint first_child = first_child_of(active_count, merged_before + (scanned.x >> 16));
    args.nodes.at[first_child] = cluster;
    args.nodes.at[first_child + 1u] = clusters[j];
    cluster = parent_of(cluster, clusters[j], first_child);
  }
  barrier();
  if (present && !retires) clusters[i - (scanned.x & 0xffffu)] = cluster;
  barrier();
  return scanned.y >> 16;
}

void main() {
  uint i = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;  // scans rank by it
  uint round_index = first_finish_round();
  PlocRound round = args.rounds.at[round_index];
  uint active_count = args.state.at[0].active_count;
  Normalisation normalisation = scene_normalisation(args.state.at[0]);
  if (i < round.cluster_count) {
    if ((round_index & 1u) == 0u) clusters[i] = args.clusters_even.at[i];
    else clusters[i] = args.clusters_odd.at[i];
  }
  barrier();

  [[dont_unroll]] while (round.cluster_count > 1u && round_index < args.rounds_bound) {
    find_neighbours(i, round.cluster_count, round.pair_all != 0u, normalisation);
    uint merged = merge(i, round.cluster_count, round.merged_before, active_count);
    round = round_after(round_index, round.cluster_count, round.merged_before, merged);
    ++round_index;
    if (i == 0u) args.rounds.at[round_index] = round;
  }
  if (i != 0u) return;
  args.state.at[0].round_count = round_index;
  if (round.cluster_count != min(active_count, 1u)) atomicOr(args.state.at[0].error_word, ERROR_PLOC_ROUNDS);
  // So that a trace in the same submit does not walk what a failed build left: it may be no tree.
  if (args.state.at[0].error_word != 0u) args.state.at[0].active_count = 0u;
  if (round.cluster_count == 1u) args.nodes.at[0] = clusters[0];
}
