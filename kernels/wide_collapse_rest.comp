// In:  a level of the wide tree. Out: all levels behind it, as by wide_collapse. One subgroup takes them in turn: a
// dispatch for each would be recorded for all trees, of which few have so many.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { WideCollapseRestArgs args; };

#define WIDE_COHERENT volatile coherent
#include "lib/wide_tile.glsl"

void main() {
  if (wide_group() != 0u) return;
  [[dont_unroll]] for (uint index = args.level; index < args.level_limit; ++index) {
    WideLevel level = args.levels.at[index];
    uint tile_count = wide_tiles(level.count);
    if (tile_count == 0u) return;
    uint before = 0u;
    [[dont_unroll]] for (uint tile = 0u; tile < tile_count; ++tile) {
      before = collapse_tile(index, level, tile, before);
      sync_memory();
    }
  }
}
