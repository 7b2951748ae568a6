// A tile's items in runs, one a subgroup, whose invocations take items side by side. CPU devices work on one subgroup
// at a time, so they go through memory in its order; with a workgroup's strides they took twice as long.
#include "lib/subgroup.glsl"

struct Run {
  uint first, last;  // of this invocation: first, first + LANES, ..., all below last
};

Run subgroup_run(uint tile_first, uint per_invocation, uint count) {
  uint run = per_invocation * LANES;
  uint first = tile_first + gl_LocalInvocationIndex / LANES * run;
  return Run(first + gl_LocalInvocationIndex % LANES, min(first + run, count));
}
