// In:  the wide tree in breadth-first order. Out: the number of wide nodes in each subtree; how far behind its parent
// each comes in depth-first order.
//
// Nodes without wide children report to their parents, and of the children of a node the last one goes on. A sum does
// not depend on who that is. Nobody waits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x = WIDE_GROUP) in;
layout(push_constant, scalar) uniform Push { WideSizesArgs args; };

#include "lib/wide_groups.glsl"

const uint SIZE_MASK = (1u << WIDE_ARRIVAL_SHIFT) - 1u;

// Whether the entry of this size is the last child of its parent to report.
bool arrives_last(WideEntry parent, uint parent_index, uint size) {
  memoryBarrierBuffer();
  // Partners: the other children of the parent. What they have summed up is visible to the last one.
  uint before = atomicAdd(args.sizes.at[parent_index], size + (1u << WIDE_ARRIVAL_SHIFT));
  memoryBarrierBuffer();
  return (before >> WIDE_ARRIVAL_SHIFT) + 1u == parent.child_count;
}

// The size of a subtree whose children have all reported; sets their offsets.
uint place_children(WideEntry parent) {
  uint size = 1u;
  [[dont_unroll]] for (uint c = parent.first_child; c < parent.first_child + parent.child_count; ++c) {
    args.offsets.at[c] = size;
    size += args.sizes.at[c] & SIZE_MASK;
  }
  return size;
}

void main() {
  uint entry = wide_group() * WIDE_GROUP + gl_LocalInvocationIndex;
  if (entry >= args.counts.at[0].node_count || args.entries.at[entry].child_count != 0u) return;
  uint size = 1u;
  [[dont_unroll]] for (uint turn = 0u; turn < WIDE_MAX_HEIGHT && entry != 0u; ++turn) {
    uint parent_index = args.entries.at[entry].parent;
    WideEntry parent = args.entries.at[parent_index];
    if (!arrives_last(parent, parent_index, size)) return;
    size = place_children(parent);
    entry = parent_index;
  }
}
