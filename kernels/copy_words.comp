// In:  words. Out: the same words elsewhere. Nothing in a build or a trace needs it: it is the limit that `coppice build`
// and `coppice render` measure the other kernels by.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/copy.h"

layout(local_size_x = COPY_GROUP) in;
layout(push_constant, scalar) uniform Push { CopyWordsArgs args; };

void main() {
  uint first = gl_WorkGroupID.x * COPY_TILE;
  uint last = min(first + COPY_TILE, args.quad_count);
  [[dont_unroll]] for (uint i = first + gl_LocalInvocationIndex; i < last; i += COPY_GROUP)
    args.target.at[i] = args.source.at[i];
}
