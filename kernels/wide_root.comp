// In:  the binary tree. Out: the first level of the wide tree, its root; nothing where there is no tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { WideCollapseArgs args; };

#define WIDE_COHERENT
#include "lib/wide_groups.glsl"
#include "lib/wide_collapse.glsl"

void main() {
  if (args.state.at[0].active_count == 0u) return;
  Node root = args.nodes.at[0];
  if (root.height > WIDE_MAX_HEIGHT) {
    atomicOr(args.state.at[0].error_word, ERROR_WIDE_TOO_DEEP);
    return;
  }
  uint child_count = enter(0u, 0u, 0u, normalisation_of(root.box_min, root.box_max));
  args.tile_sums.at[0] = child_count;
  args.block_sums.at[0] = child_count;
  args.levels.at[0] = planned_level(0u, 1u, 0u, 0u);
}
