// In:  a level of the wide tree, and the sizes of the subtrees below it. Out: the sizes of the level's own; how far
// behind their parents its children come in depth-first order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x = WIDE_TILE) in;
layout(push_constant, scalar) uniform Push { WideSizesArgs args; };

#include "lib/wide_groups.glsl"

void main() {
  WideLevel level = args.levels.at[args.level];
  uint index = wide_group() * WIDE_TILE + gl_LocalInvocationIndex;
  if (index >= level.count) return;
  WideEntry entry = args.entries.at[level.first + index];
  uint size = 1u;
  [[dont_unroll]] for (uint c = 0u; c < entry.child_count; ++c) {
    args.offsets.at[entry.first_child + c] = size;
    size += args.sizes.at[entry.first_child + c];
  }
  args.sizes.at[level.first + index] = size;
}
