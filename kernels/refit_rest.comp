// In:  a tree whose lower levels have their boxes. Out: the boxes of all levels above, as by refit_boxes. One workgroup
// takes them in turn, as most trees have few nodes there; it also gives a tree of one leaf its box.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"

layout(local_size_x = REFIT_REST_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitRestArgs args; };

#include "lib/refit_box.glsl"

void refit(uint node, uint height) {
  uint pair = args.nodes.at[node].child;
  Node left = args.nodes.at[pair], right = args.nodes.at[pair + 1u];
  if (left.height == 0u) {
    left = refitted_leaf(left.child);
    args.nodes.at[pair] = left;
  }
  if (right.height == 0u) {
    right = refitted_leaf(right.child);
    args.nodes.at[pair + 1u] = right;
  }
  args.nodes.at[node] = refitted_parent(left, right, pair, height);
}

void main() {
  if (args.state.at[0].active_count == 1u && gl_LocalInvocationIndex == 0u) {
    Node root = args.nodes.at[0];
    args.nodes.at[0] = refitted_leaf(root.child);
  }
  [[dont_unroll]] for (uint index = args.level; index < REFIT_MAX_HEIGHT; ++index) {
    RefitLevel level = args.levels.at[index];
    if (level.count == 0u) return;
    [[dont_unroll]] for (uint i = gl_LocalInvocationIndex; i < level.count; i += REFIT_REST_GROUP)
      refit(args.order.at[level.first + i], index + 1u);
    memoryBarrierBuffer();
    barrier();
  }
}
