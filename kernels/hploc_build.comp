// In:  boxes of the triangles and their Morton order. Out: the tree.
// Benthin et al. 2024; the climb is that of Apetrei, "Fast and Simple Agglomerative LBVH Construction", 2014.
//
// The radix tree over the codes is climbed and not built. Where a node has more clusters than it may leave to its
// parent they are merged. What is left depends only on the node, so the tree does not depend on who comes first.
// A subgroup starts with the greatest nodes that lie within its tile, all leaves of which it merges at once. Their
// parents reach over the border. Nodes arrive at the parent's split in memory, and of two arrivals the second goes on.
// Nobody waits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/hploc.h"
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 0) const uint CLUSTER_LIMIT = HPLOC_CLUSTERS;  // args.cluster_limit
layout(constant_id = 1) const uint RADIUS = 8u;                     // args.radius
layout(push_constant, scalar) uniform Push { HplocBuildArgs args; };

#include "lib/hploc_level.glsl"
#include "lib/subgroup.glsl"
#include "lib/hploc_list.glsl"
#include "lib/hploc_search.glsl"

shared uint levels[HPLOC_TILE + 1];  // of the split before each place of the tile, and behind the last one
#include "lib/hploc_merge.glsl"
#include "lib/hploc_tile.glsl"

// Clusters that wait for those of the sibling.
layout(buffer_reference, scalar, buffer_reference_align = 16) volatile coherent buffer CoherentNodeWordsBuffer {
  u64vec4 at[];
};

// Leaves a node's clusters in memory, for arrive() to release.
void publish(Range node, List its) {
  CoherentNodeWordsBuffer clusters = CoherentNodeWordsBuffer(args.clusters);
  [[dont_unroll]] for (uint i = lane(); i < node.clusters; i += LANES) {
    uint slot = list[its.base + i];
    clusters.at[node.first + i] = cluster_words[slot];
    args.cluster_names.at[node.first + i] = name_of(slot, its);
  }
  sync();
}

// Arrives at the split of the node's parent. Returns what the sibling left there, 0 if it is still to come.
uint arrive(Range node, uint split) {
  uint word = (split == node.last ? node.first : node.last) << HPLOC_ARRIVAL_SHIFT | node.clusters;
  uint found = 0u;
  if (lane() == 0u) {
    // Releases what all lanes published: their sync() came before. A fence by each of them before sync() would release
    // nothing, as only this lane goes on to an atomic.
    memoryBarrierBuffer();
    // Partner: the same line of the sibling, in whatever workgroup. What either published is visible to the second.
    found = atomicExchange(args.arrivals.at[split], word);
    memoryBarrierBuffer();
    if (found != 0u) args.arrivals.at[split] = 0u;
  }
  found = subgroupBroadcastFirst(found);
  sync();  // hands what lane 0 acquired to the others
  return found;
}

// Brings the published clusters of both children into the first slots, in order. Returns whether one is tall.
bool fetch(Range left, Range right) {
  CoherentNodeWordsBuffer clusters = CoherentNodeWordsBuffer(args.clusters);
  bool tall = false;
  [[dont_unroll]] for (uint i = lane(); i < left.clusters + right.clusters; i += LANES) {
    uint place = i < left.clusters ? left.first + i : right.first + i - left.clusters;
    u64vec4 words = clusters.at[place];
    cluster_words[i] = words;
    names[i] = args.cluster_names.at[place];
    list[i] = i;
    tall = tall || node_of(words).height >= HPLOC_TALL;
  }
  sync();
  return subgroupAny(tall);
}

void write_root() {
  if (lane() == 0u) NodeWordsBuffer(args.nodes).at[0] = cluster_words[list[0]];
}

// Climbs from a published node as long as its sibling is there before it.
void climb(Range node, uint place_count, Normalisation normalisation) {
  [[dont_unroll]] for (uint step = 0u; step < HPLOC_LEVELS; ++step) {
    bool second = level_before(node.first, place_count) < level_before(node.last + 1u, place_count);
    uint word = arrive(node, second ? node.first - 1u : node.last);
    if (word == 0u) return;
    uint far_end = word >> HPLOC_ARRIVAL_SHIFT, far_clusters = word & (HPLOC_LIST - 1u);
    Range left = second ? Range(far_end, node.first - 1u, far_clusters) : node;
    Range right = second ? node : Range(node.last + 1u, far_end, far_clusters);
    bool tall = fetch(left, right);
    List its = List(0u, left.clusters + right.clusters, 0u, true);
    bool root = left.first == 0u && right.last + 1u == place_count;
    uint clusters = merge_list(its, root ? 1u : CLUSTER_LIMIT, tall, normalisation);
    if (root) {
      write_root();
      return;
    }
    node = Range(left.first, right.last, clusters);
    publish(node, its);
  }
}

void main() {
  uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  BuildState state = args.state.at[0];
  if (state.error_word != 0u) {
    // What is not sorted has no tree, and a trace in the same submit walks none.
    if (tile == 0u && lane() == 0u) args.state.at[0].active_count = 0u;
    return;
  }
  uint first = tile * HPLOC_TILE;
  if (first >= state.active_count) return;
  uint last = min(first + HPLOC_TILE, state.active_count) - 1u;
  Normalisation normalisation = scene_normalisation(state);

  load_tile(first, last, state.active_count);
  uint count = find_ranges(first, last);
  bool root = count == 1u && first == 0u && last + 1u == state.active_count;
  [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
    Range node = range_of(i, last);
    List its = List(node.first - first, node.last - node.first + 1u, first, false);
    node.clusters = merge_list(its, root ? 1u : CLUSTER_LIMIT, false, normalisation);
    if (root) {
      write_root();
      return;
    }
    publish(node, its);
    keep_range(i, node);
  }
  [[dont_unroll]] for (uint i = 0u; i < count; ++i) climb(range_of(i, last), state.active_count, normalisation);
}
