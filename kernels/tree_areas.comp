// In:  a tree. Out: for each tile of nodes the sum of their half areas: MacDonald and Booth 1990, "Heuristics for Ray
// Tracing Using Space Subdivision".
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"

layout(local_size_x = TREE_AREAS_GROUP) in;
layout(push_constant, scalar) uniform Push { TreeAreasArgs args; };

#include "lib/tree_area.glsl"
#include "lib/wide_rows.glsl"

void main() {
  uint tile = wide_group(), count = min(tree_nodes(), args.node_limit);
  uint first = tile * TREE_AREAS_TILE;
  if (first >= count) return;
  Normalisation normalisation = tree_normalisation();
  float part = 0.0;
  [[dont_unroll]] for (uint i = first + gl_LocalInvocationIndex; i < min(first + TREE_AREAS_TILE, count);
                       i += TREE_AREAS_GROUP)
    part = sum_of(part, half_area(load_node(args.nodes, i), normalisation));
  float sum = group_sum(part);
  if (gl_LocalInvocationIndex == 0u) args.tile_areas.at[tile] = sum;
}
