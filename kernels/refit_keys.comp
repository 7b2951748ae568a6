// In:  a tree. Out: for each pair of children its parent, and a key by the parent's height and by which of the children are
// leaves: what is sorted for the order of refits. By the pair, as then nodes that follow each other in the order have
// children that lie side by side, whoever built the tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"
#include "lib/node_words.glsl"
#include "lib/subgroup_run.glsl"

layout(local_size_x = REFIT_KEYS_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitKeysArgs args; };

uint node_count() {
  uint active_count = args.state.at[0].active_count;
  return active_count == 0u ? 0u : min(2u * active_count - 1u, args.node_limit);
}

void main() {
  uint count = node_count();
  bool too_deep = count != 0u && args.nodes.at[0].height > REFIT_MAX_HEIGHT;
  if (gl_GlobalInvocationID.x == 0u) {
    args.pair_count.at[0] = too_deep ? 0u : count / 2u;
    if (too_deep) atomicOr(args.state.at[0].error_word, ERROR_REFIT_TOO_DEEP);
  }
  if (too_deep) return;
  Run run = subgroup_run(gl_WorkGroupID.x * REFIT_KEYS_TILE, REFIT_KEYS_PER_INVOCATION, count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    Node node = load_node(args.nodes, i);
    if (node.height == 0u) continue;
    uint pair = (node.child - 1u) / 2u;
    uint kind = (args.nodes.at[node.child].height != 0u ? REFIT_RIGHT_LEAF : 0u) |
                (args.nodes.at[node.child + 1u].height != 0u ? REFIT_LEFT_LEAF : 0u);
    args.keys.at[pair] = (node.height - 1u) * 4u + kind;
    args.parents.at[pair] = i;
  }
}
