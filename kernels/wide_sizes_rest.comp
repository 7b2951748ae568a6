// In:  all levels of the wide tree. Out: sizes and offsets, as by wide_sizes, of the levels from one on. One subgroup
// takes them in turn, the last one first.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { WideSizesRestArgs args; };

#include "lib/subgroup.glsl"
#include "lib/wide_groups.glsl"
#include "lib/wide_size.glsl"

void main() {
  if (wide_group() != 0u) return;
  [[dont_unroll]] for (uint level = args.level_limit; level-- > args.level;) {
    WideLevel its = args.levels.at[level];
    [[dont_unroll]] for (uint i = lane(); i < its.count; i += LANES) measure(its.first + i);
    sync_memory();
  }
}
