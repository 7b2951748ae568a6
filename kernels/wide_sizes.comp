// In:  a level of the wide tree, and the sizes of the subtrees below it. Out: the sizes of the level's own; how far
// behind their parents its children come in depth-first order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x = WIDE_TILE) in;
layout(push_constant, scalar) uniform Push { WideSizesArgs args; };

#include "lib/wide_groups.glsl"
#include "lib/wide_size.glsl"

void main() {
  WideLevel level = args.levels.at[args.level];
  uint index = wide_group() * WIDE_TILE + gl_LocalInvocationIndex;
  if (index < level.count) measure(level.first + index);
}
