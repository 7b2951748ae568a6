// In:  boxes of the triangles and their Morton order. Out: the tree.
// Benthin et al. 2024; the climb is that of Apetrei, "Fast and Simple Agglomerative LBVH Construction", 2014.
//
// The radix tree over the codes is climbed and not built. Where a node has more clusters than it may leave to its
// parent they are merged. What is left depends only on the node, so the tree does not depend on who comes first.
// A subgroup climbs by itself through the nodes that lie within its tile, from left to right with a stack. Nodes whose
// parents reach over the border arrive at the parent's split in memory, and of two arrivals the second goes on. Nobody
// waits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "interface/hploc.h"
#include "interface/ploc.h"
#include "lib/ploc_round.glsl"
#include "lib/ploc_box.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 0) const uint CLUSTER_LIMIT = HPLOC_CLUSTERS;  // args.cluster_limit
layout(push_constant, scalar) uniform Push { HplocBuildArgs args; };

#include "lib/hploc_level.glsl"
#include "lib/subgroup_sync.glsl"
#include "lib/hploc_merge.glsl"

// A complete node: the places from first to last, and how many clusters are left of them.
struct Range {
  uint first, last, clusters;
};

shared uint levels[HPLOC_TILE + 1];       // of the split before each place of the tile, and behind the last one
shared uint open_nodes[2 * HPLOC_LEVELS];  // first place and clusters; each ends where the next one begins

void load_tile(uint first, uint last, uint place_count) {
  [[dont_unroll]] for (uint i = lane(); i <= last - first; i += lanes()) {
    uint triangle = args.values.at[first + i];
    Aabb box = args.boxes.at[triangle];
    uint words[NODE_WORDS] = uint[NODE_WORDS](
        floatBitsToUint(box.box_min.x), floatBitsToUint(box.box_min.y), floatBitsToUint(box.box_min.z), triangle,
        floatBitsToUint(box.box_max.x), floatBitsToUint(box.box_max.y), floatBitsToUint(box.box_max.z), 0u);
    [[unroll]] for (uint word = 0u; word < NODE_WORDS; ++word) cluster_words[i * NODE_WORDS + word] = words[word];
    names[i] = first + i;
    list[i] = i;
    levels[i] = level_before(first + i, place_count);
  }
  if (lane() == 0u) levels[last + 1u - first] = level_before(last + 1u, place_count);
  sync();
}

// Puts the clusters of `right` behind those of `left` in the list of the tile, and merges them.
uint join_in_tile(uint base, Range left, Range right, uint target, Normalisation normalisation) {
  uint to = left.first - base + left.clusters, from = right.first - base;
  if (to != from) {
    [[dont_unroll]] for (uint first = 0u; first < right.clusters; first += lanes()) {
      uint i = first + lane();
      uint slot = i < right.clusters ? list[from + i] : 0u;
      sync();
      if (i < right.clusters) list[to + i] = slot;
      sync();
    }
  }
  return merge_list(left.first - base, left.clusters + right.clusters, target, normalisation);
}

// Completes the nodes within the tile. Returns how many there are without a parent in it, in open_nodes, from left to
// right.
uint build_tile(uint first, uint last, uint place_count, Normalisation normalisation) {
  uint count = 0u;
  uint bottom = first;  // no open node that waits for its sibling begins before
  [[dont_unroll]] for (uint place = first; place <= last; ++place) {
    Range node = Range(place, place, 1u);
    uint level_behind = levels[place - first + 1u];
    // Second children first: their sibling, if it lies in the tile, is the last open node.
    [[dont_unroll]] while (node.first != bottom && levels[node.first - first] < level_behind) {
      uint word = open_nodes[--count];
      sync();
      Range sibling = Range(word >> HPLOC_ARRIVAL_SHIFT, node.first - 1u, word & (HPLOC_LIST - 1u));
      bool root = sibling.first == 0u && place + 1u == place_count;
      uint left = join_in_tile(first, sibling, node, root ? 1u : CLUSTER_LIMIT, normalisation);
      node = Range(sibling.first, place, left);
    }
    if (levels[node.first - first] < level_behind) bottom = place + 1u;
    if (lane() == 0u) open_nodes[count] = node.first << HPLOC_ARRIVAL_SHIFT | node.clusters;
    ++count;
    sync();
  }
  return count;
}

// Leaves a node's clusters in memory; `base`: where they are in the list.
void publish(Range node, uint base) {
  CoherentUintBuffer words = CoherentUintBuffer(args.clusters);
  [[dont_unroll]] for (uint i = lane(); i < node.clusters * NODE_WORDS; i += lanes()) {
    uint slot = list[base + i / NODE_WORDS], word = i % NODE_WORDS;
    words.at[names[slot] * NODE_WORDS + word] = cluster_words[slot * NODE_WORDS + word];
    if (word == 0u) args.cluster_names.at[node.first + i / NODE_WORDS] = names[slot];
  }
  memoryBarrierBuffer();
  sync();
}

// Arrives at the split of the node's parent. Returns what the sibling left there, 0 if it is still to come.
uint arrive(Range node, uint split) {
  uint word = (split == node.last ? node.first : node.last) << HPLOC_ARRIVAL_SHIFT | node.clusters;
  uint found = 0u;
  if (lane() == 0u) {
    // Partner: the same line of the sibling, in whatever workgroup. What either published is visible to the second.
    found = atomicExchange(args.arrivals.at[split], word);
    memoryBarrierBuffer();
    if (found != 0u) args.arrivals.at[split] = 0u;
  }
  found = subgroupBroadcastFirst(found);
  memoryBarrierBuffer();
  sync();
  return found;
}

// Brings the published clusters of both children into the first slots, in order.
void fetch(Range left, Range right) {
  [[dont_unroll]] for (uint i = lane(); i < left.clusters + right.clusters; i += lanes()) {
    uint place = i < left.clusters ? left.first + i : right.first + i - left.clusters;
    uint name = args.cluster_names.at[place];
    names[i] = name;
    list[i] = i;
  }
  sync();
  CoherentUintBuffer words = CoherentUintBuffer(args.clusters);
  [[dont_unroll]] for (uint i = lane(); i < (left.clusters + right.clusters) * NODE_WORDS; i += lanes())
    cluster_words[i] = words.at[names[i / NODE_WORDS] * NODE_WORDS + i % NODE_WORDS];
  sync();
}

void write_root() {
  UintBuffer node_words = UintBuffer(args.nodes);
  [[dont_unroll]] for (uint word = lane(); word < NODE_WORDS; word += lanes())
    node_words.at[word] = cluster_words[list[0] * NODE_WORDS + word];
}

// Climbs from a published node as long as its sibling is there before it.
void climb(Range node, uint place_count, Normalisation normalisation) {
  [[dont_unroll]] for (uint step = 0u; step < HPLOC_LEVELS; ++step) {
    bool second = level_before(node.first, place_count) < level_before(node.last + 1u, place_count);
    uint word = arrive(node, second ? node.first - 1u : node.last);
    if (word == 0u) return;
    uint far_end = word >> HPLOC_ARRIVAL_SHIFT, far_clusters = word & (HPLOC_LIST - 1u);
    Range sibling = second ? Range(far_end, node.first - 1u, far_clusters)
                           : Range(node.last + 1u, far_end, far_clusters);
    if (second) fetch(sibling, node);
    else fetch(node, sibling);
    node.first = min(node.first, sibling.first);
    node.last = max(node.last, sibling.last);
    bool root = node.first == 0u && node.last + 1u == place_count;
    node.clusters =
        merge_list(0u, node.clusters + far_clusters, root ? 1u : CLUSTER_LIMIT, normalisation);
    if (root) {
      write_root();
      return;
    }
    publish(node, 0u);
  }
}

Range open_node(uint i, uint count, uint last) {
  uint word = open_nodes[i];
  uint end = i + 1u < count ? (open_nodes[i + 1u] >> HPLOC_ARRIVAL_SHIFT) - 1u : last;
  return Range(word >> HPLOC_ARRIVAL_SHIFT, end, word & (HPLOC_LIST - 1u));
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
  uint count = build_tile(first, last, state.active_count, normalisation);
  if (first == 0u && count == 1u && last + 1u == state.active_count) {
    write_root();
    return;
  }
  [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
    Range node = open_node(i, count, last);
    publish(node, node.first - first);
  }
  [[dont_unroll]] for (uint i = 0u; i < count; ++i)
    climb(open_node(i, count, last), state.active_count, normalisation);
}
