// In:  boxes of primitives; ranges of them. Out: a tree over each range, as a build by itself of just these primitives
// gives it: primitives by their place in the range, nodes by theirs in the tree.
// A subgroup builds one tree in shared memory: its box, the Morton codes of its own grid, a sort (Batcher 1968, "Sorting
// Networks and Their Applications"), and the rounds of PLOC as in ploc_finish.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/batch.h"
#include "interface/morton.h"
#include "lib/ploc_round.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 0) const uint RADIUS = 8u;  // args.radius
layout(push_constant, scalar) uniform Push { BatchBuildArgs args; };

#include "lib/count_error.glsl"
#include "lib/extent.glsl"
#include "lib/morton_grid.glsl"
#include "lib/node_words.glsl"
#include "lib/subgroup.glsl"
#include "lib/ploc_tile.glsl"
#include "lib/ploc_place.glsl"

shared u64vec4 clusters[BATCH_MAX_PRIMITIVES];
shared uint partners[BATCH_MAX_PRIMITIVES];  // before the first round: primitives in Morton order
shared uint64_t codes[BATCH_MAX_PRIMITIVES];

BatchRange range;
BuildState state;  // of the tree
Normalisation normalisation;

Node load_cluster(uint i) { return node_of(clusters[i]); }
void store_cluster(uint place, Node cluster) { clusters[place] = words_of(cluster); }
void keep_partner(uint i, uint partner) { partners[i] = partner; }
uint partner_of(uint i) { return partners[i]; }
void sync_clusters() { sync(); }
uint tree_active_count() { return state.active_count; }
Normalisation tree_normalisation() { return normalisation; }
void store_tree_node(uint i, Node node) { store_node(args.nodes, 2u * range.first + i, node); }

bool in_bounds() {
  uint primitive_count = counted(args.primitives_at, args.primitive_count);
  return range.count <= BATCH_MAX_PRIMITIVES && range.first <= primitive_count &&
         range.count <= primitive_count - range.first;
}

void measure_range() {
  Extent extent = no_extent();
  [[dont_unroll]] for (uint i = lane(); i < range.count; i += LANES) {
    Aabb box = load_box(args.boxes, range.first + i);
    if (!is_empty(box)) add_box(extent, box);
  }
  extent = subgroup_extent(extent);
  state = BuildState(extent.min_complement, extent.active_count, extent.box_max, 0u, 0u, 0u, 0u, 0u);
  normalisation = scene_normalisation(state);
}

// Up to `size` codes; those behind the range sort behind all others.
void code_range(uint size) {
  Grid grid = scene_grid(state, 10u * args.key_words);
  [[dont_unroll]] for (uint i = lane(); i < size; i += LANES) {
    uvec2 key = uvec2(MORTON_INACTIVE);
    if (i < range.count) key = morton_key(load_box(args.boxes, range.first + i), grid);
    codes[i] = packUint2x32(key);
    partners[i] = i;
  }
  sync();
}

// Puts the pair at i and j, i < j, into this order.
void order_pair(uint i, uint j, bool ascending) {
  uint64_t code = codes[i], other_code = codes[j];
  uint primitive = partners[i], other = partners[j];
  bool in_order = code < other_code || (code == other_code && primitive < other);
  bool swap = in_order != ascending;
  codes[i] = swap ? other_code : code;
  codes[j] = swap ? code : other_code;
  partners[i] = swap ? other : primitive;
  partners[j] = swap ? primitive : other;
}

// No two are equal, so by (code, primitive) the order is that of a stable sort. `size` is a power of two.
void sort_codes(uint size) {
  [[dont_unroll]] for (uint run = 2u; run <= size; run <<= 1) {
    [[dont_unroll]] for (uint gap = run >> 1; gap > 0u; gap >>= 1) {
      [[dont_unroll]] for (uint pair = lane(); pair < size / 2u; pair += LANES) {
        uint i = 2u * pair - (pair & (gap - 1u));
        order_pair(i, i + gap, (i & run) == 0u);
      }
      sync();
    }
  }
}

void load_leaves() {
  [[dont_unroll]] for (uint i = lane(); i < state.active_count; i += LANES) {
    uint primitive = partners[i];
    Aabb box = load_box(args.boxes, range.first + primitive);
    store_cluster(i, Node(box.box_min, primitive, box.box_max, 0u));
  }
  sync();
}

// Returns the number of rounds; too many: the bound's.
uint merge_all(out uint cluster_count) {
  PlocRound round = planned_round(state.active_count, 0u, false);
  uint round_index = 0u;
  [[dont_unroll]] while (round.cluster_count > 1u && round_index < BATCH_ROUNDS_BOUND) {
    find_partners(0u, round, true);
    uvec2 merged = place_tile(0u, round, uvec2(0u));
    sync();
    round = round_after(round_index, round.cluster_count, round.merged_before, merged.x);
    ++round_index;
  }
  cluster_count = round.cluster_count;
  return round_index;
}

BatchTree build_tree() {
  measure_range();
  uint size = range.count <= 1u ? range.count : 2u << findMSB(range.count - 1u);
  code_range(size);
  sort_codes(size);
  load_leaves();
  uint cluster_count, round_count = merge_all(cluster_count);
  if (cluster_count != min(state.active_count, 1u)) return BatchTree(0u, round_count, ERROR_PLOC_ROUNDS, 0u);
  if (cluster_count == 1u && lane() == 0u) store_tree_node(0u, load_cluster(0u));
  return BatchTree(state.active_count, round_count, 0u, 0u);
}

void main() {
  uint tree = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (tree == 0u && lane() == 0u) note_count(args.state, args.count_at, args.range_count);
  if (tree >= counted(args.count_at, args.range_count)) return;
  range = args.ranges.at[tree];
  BatchTree record = BatchTree(0u, 0u, ERROR_BATCH_RANGE, 0u);
  if (in_bounds()) record = build_tree();
  if (lane() != 0u) return;
  args.trees.at[tree] = record;
  if (record.error_word != 0u) atomicOr(args.state.at[0].error_word, record.error_word);  // partners: other trees
}
