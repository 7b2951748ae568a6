// In:  the sums of all tiles. Out: their sum, and the root's half area: the SAH cost is one by the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"

layout(local_size_x = TREE_AREAS_GROUP) in;
layout(push_constant, scalar) uniform Push { TreeAreaSumArgs args; };

#include "lib/tree_area.glsl"

void main() {
  uint count = tree_nodes();
  float part = 0.0;
  [[dont_unroll]] for (uint tile = gl_LocalInvocationIndex; tile < (count + TREE_AREAS_TILE - 1u) / TREE_AREAS_TILE;
                       tile += TREE_AREAS_GROUP)
    part = sum_of(part, args.tile_areas.at[tile]);
  float sum = group_sum(part);
  if (gl_LocalInvocationIndex != 0u) return;
  args.refit.at[0].area_sum = sum;
  args.refit.at[0].root_area = count == 0u ? 0.0 : half_area(load_node(args.nodes, 0u), tree_normalisation());
}
