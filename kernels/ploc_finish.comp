// In:  the last clusters, at most PLOC_FINISH_CLUSTERS. Out: the rest of the nodes with the root at 0, the rest of the
// rounds, their number. One subgroup does all rounds, each as ploc_merge does one, over a list in shared memory. Most
// rounds have few blocks, where the steps of one subgroup take less time than barriers between many.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 0) const uint RADIUS = 8u;  // args.radius
layout(push_constant, scalar) uniform Push { PlocFinishArgs args; };

#include "lib/node_words.glsl"
#include "lib/subgroup.glsl"
#include "lib/ploc_tile.glsl"
#include "lib/ploc_place.glsl"

shared u64vec4 clusters[PLOC_FINISH_CLUSTERS];
shared uint partners[PLOC_FINISH_CLUSTERS];

Node load_cluster(uint i) { return node_of(clusters[i]); }
void store_cluster(uint place, Node cluster) { clusters[place] = words_of(cluster); }
void keep_partner(uint i, uint partner) { partners[i] = partner; }
uint partner_of(uint i) { return partners[i]; }
void sync_clusters() { sync(); }
Normalisation tree_normalisation() { return scene_normalisation(args.state.at[0]); }
uint tree_active_count() { return args.state.at[0].active_count; }
void store_tree_node(uint i, Node node) { store_node(args.nodes, i, node); }

uint first_finish_round() {
  uint round = 0u;
  [[dont_unroll]] while (round < args.rounds_bound && args.rounds.at[round].merge_groups.x != 0u) ++round;
  return round;
}

void load_clusters(uint round_index, uint cluster_count) {
  NodeBuffer list = args.clusters_even;
  if ((round_index & 1u) != 0u) list = args.clusters_odd;
  [[dont_unroll]] for (uint i = lane(); i < cluster_count; i += LANES) store_cluster(i, load_node(list, i));
  sync();
}

void main() {
  uint round_index = first_finish_round();
  PlocRound round = args.rounds.at[round_index];
  uint active_count = args.state.at[0].active_count;
  // More are left only behind the last round, and then it is an error, set below.
  load_clusters(round_index, min(round.cluster_count, PLOC_FINISH_CLUSTERS));

  [[dont_unroll]] while (round.cluster_count > 1u && round_index < args.rounds_bound) {
    find_partners(0u, round, true);
    uvec2 merged = place_tile(0u, round, uvec2(0u));
    sync();
    round = round_after(round_index, round.cluster_count, round.merged_before, merged.x);
    ++round_index;
    if (lane() == 0u) args.rounds.at[round_index] = round;
  }
  if (lane() != 0u) return;
  args.state.at[0].round_count = round_index;
  if (round.cluster_count != min(active_count, 1u)) atomicOr(args.state.at[0].error_word, ERROR_PLOC_ROUNDS);
  // So that a trace in the same submit does not walk what a failed build left: it may be no tree.
  if (args.state.at[0].error_word != 0u) args.state.at[0].active_count = 0u;
  if (round.cluster_count == 1u) args.nodes.at[0] = load_cluster(0u);
}
