// In:  the heights of the inner nodes in ascending order. Out: where those of each height begin, and how many there are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"
#include "lib/wide_rows.glsl"

layout(local_size_x = REFIT_MAX_HEIGHT) in;
layout(push_constant, scalar) uniform Push { RefitLevelsArgs args; };

// The first place of a height that is not less.
uint find_first(uint height, uint count) {
  uint first = 0u;
  [[dont_unroll]] for (uint step = 0x80000000u; step != 0u; step >>= 1)
    if (step <= count - first && args.heights.at[first + step - 1u] < height) first += step;
  return first;
}

void main() {
  uint level = gl_LocalInvocationIndex, count = args.pair_count.at[0];
  uint first = find_first(level, count), last = find_first(level + 1u, count);
  args.levels.at[level] =
      RefitLevel(first, last - first, 0u, 0u, wide_rows((last - first + REFIT_TILE - 1u) / REFIT_TILE), 0u);
  if (level == 0u) args.levels.at[REFIT_MAX_HEIGHT] = RefitLevel(count, 0u, 0u, 0u, uvec3(0u), 0u);
}
