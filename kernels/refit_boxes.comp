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

void main() {
  RefitLevel level = args.levels.at[args.level];
  Run run = subgroup_run(wide_group() * REFIT_TILE, REFIT_PER_INVOCATION, level.count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    uint node = args.order.at[level.first + i];
    uint pair = args.nodes.at[node].child;
    Node left = load_node(args.nodes, pair), right = load_node(args.nodes, pair + 1u);
    if (left.height == 0u) {
      left = refitted_leaf(left);
      store_node(args.nodes, pair, left);
    }
    if (right.height == 0u) {
      right = refitted_leaf(right);
      store_node(args.nodes, pair + 1u, right);
    }
    store_node(args.nodes, node, refitted_parent(left, right, pair, args.level + 1u));
  }
}
