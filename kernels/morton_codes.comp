// In:  primitive boxes and the scene's box. Out: sort keys (Morton codes of the box centres) and values (indices).
// The grid is cubic and its cell a power of two, so that a code is decided by exact multiplications alone.
// Morton 1966; 30 and 60 bits as in Lauterbach et al. 2009 and Meister and Bittner 2018.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/morton.h"
#include "lib/device_count.glsl"
#include "lib/morton_grid.glsl"
#include "lib/node_words.glsl"
#include "lib/subgroup_run.glsl"

layout(local_size_x = MORTON_GROUP) in;
layout(push_constant, scalar) uniform Push { MortonCodesArgs args; };

void main() {
  uint count = counted(args.count_at, args.triangle_count);
  if (gl_WorkGroupID.x * MORTON_TILE >= count) return;
  Grid grid = scene_grid(args.state.at[0], 10u * args.key_words);
  Run run = subgroup_run(gl_WorkGroupID.x * MORTON_TILE, MORTON_PER_INVOCATION, count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    uvec2 key = morton_key(load_box(args.boxes, i), grid);
    args.keys.at[i * args.key_words] = key.x;
    if (args.key_words == 2u) args.keys.at[i * 2u + 1u] = key.y;
    args.values.at[i] = i;
  }
}
