// In:  a tree whose nodes lower than this level's have their boxes, but for leaves. Out: the boxes of the level's nodes, and
// of the leaves below them, by the triangles as they lie now. Nothing else of a node changes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"
#include "lib/node_words.glsl"
#include "lib/subgroup_run.glsl"
#include "lib/wide_rows.glsl"

layout(local_size_x = REFIT_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitBoxesArgs args; };

#include "lib/refit_box.glsl"

// Nodes of an invocation whose memory is on its way at a time.
const uint AHEAD = REFIT_PER_INVOCATION;

// Of the order's places in [first, last), in the whole workgroup. What is a leaf is a constant at every call.
void refit_range(uint first, uint last, uint height, const bool left_is_leaf, const bool right_is_leaf) {
  Run run = subgroup_run(first, REFIT_PER_INVOCATION, last);
  if (run.first >= run.last) return;
  uint nodes[AHEAD], pairs[AHEAD];
  Node left[AHEAD], right[AHEAD];
  [[unroll]] for (uint k = 0u; k < AHEAD; ++k)
    nodes[k] = args.order.at[min(run.first + k * LANES, run.last - 1u)];
  [[unroll]] for (uint k = 0u; k < AHEAD; ++k) pairs[k] = args.nodes.at[nodes[k]].child;
  [[unroll]] for (uint k = 0u; k < AHEAD; ++k) {
    left[k].child = right[k].child = 0u;
    if (left_is_leaf) left[k].child = args.nodes.at[pairs[k]].child;
    else left[k] = load_node(args.nodes, pairs[k]);
    if (right_is_leaf) right[k].child = args.nodes.at[pairs[k] + 1u].child;
    else right[k] = load_node(args.nodes, pairs[k] + 1u);
  }
  [[unroll]] for (uint k = 0u; k < AHEAD; ++k) {
    if (left_is_leaf) left[k] = refitted_leaf(left[k].child);
    if (right_is_leaf) right[k] = refitted_leaf(right[k].child);
  }
  [[unroll]] for (uint k = 0u; k < AHEAD; ++k) {
    if (run.first + k * LANES >= run.last) continue;
    if (left_is_leaf) store_node(args.nodes, pairs[k], left[k]);
    if (right_is_leaf) store_node(args.nodes, pairs[k] + 1u, right[k]);
    store_node(args.nodes, nodes[k], refitted_parent(left[k], right[k], pairs[k], height));
  }
}

void main() {
  RefitLevel level = args.levels.at[args.level];
  uint height = args.level + 1u;
  uint first = level.first + wide_group() * REFIT_TILE, last = min(first + REFIT_TILE, level.first + level.count);
  if (args.level == 0u) {
    refit_range(first, last, height, true, true);
    return;
  }
  uint left_end = level.first + level.left_end, right_end = level.first + level.right_end;
  if (first < left_end) refit_range(first, min(last, left_end), height, true, false);
  if (first < right_end && last > left_end)
    refit_range(max(first, left_end), min(last, right_end), height, false, true);
  if (last > right_end) refit_range(max(first, right_end), last, height, false, false);
}
