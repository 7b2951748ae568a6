// In:  the keys of the inner nodes in ascending order. Out: where those of each height begin, and how many there are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"
#include "lib/wide_rows.glsl"

layout(local_size_x = REFIT_MAX_HEIGHT) in;
layout(push_constant, scalar) uniform Push { RefitLevelsArgs args; };

// The first place of a key that is not less.
uint find_first(uint key, uint count) {
  uint first = 0u;
  [[dont_unroll]] for (uint step = 0x80000000u; step != 0u; step >>= 1)
    if (step <= count - first && args.keys.at[first + step - 1u] < key) first += step;
  return first;
}

void main() {
  uint level = gl_LocalInvocationIndex, all = args.pair_count.at[0];
  uint first = find_first(level * 4u, all), count = find_first(level * 4u + 4u, all) - first;
  uint left_end = find_first(level * 4u + REFIT_RIGHT_LEAF, all) - first;
  uint right_end = find_first(level * 4u + REFIT_NO_LEAF, all) - first;
  uvec3 groups = wide_rows((count + REFIT_TILE - 1u) / REFIT_TILE);
  args.levels.at[level] = RefitLevel(first, count, left_end, right_end, groups, 0u);
  if (level == 0u) args.levels.at[REFIT_MAX_HEIGHT] = RefitLevel(all, 0u, 0u, 0u, uvec3(0u), 0u);
}
