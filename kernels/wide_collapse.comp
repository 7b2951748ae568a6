// In:  a level of the wide tree. Out: the next level: of each wide node the binary nodes that are its children.
// The children of a level follow each other in the order of their parents, so the prefix sums of child counts number
// them. Each level leaves its counts summed by tiles, and a tile of the next dispatch adds up those before it: nobody
// waits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { WideCollapseArgs args; };

#define WIDE_COHERENT
#include "lib/wide_tile.glsl"

void main() {
  WideLevel level = args.levels.at[args.level];
  uint tile = wide_group();
  if (tile < wide_tiles(level.count)) collapse_tile(args.level, level, tile, sum_before(level, tile));
}
