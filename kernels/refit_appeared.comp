// In:  triangles that have moved, and which of them have no leaf. Out: how many of those are active now: their tree is not
// one over the triangles as they are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"

layout(local_size_x = REFIT_ABSENT_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitAppearedArgs args; };

#include "lib/refit_absent.glsl"
#include "lib/refit_box.glsl"

void main() {
  uint word = gl_GlobalInvocationID.x, appeared = 0u;
  if (word * 32u < absent_limit()) {
    uint bits = args.absent.at[word];
    [[dont_unroll]] for (uint turn = 0u; turn < 32u && bits != 0u; ++turn) {
      uint bit = uint(findLSB(bits));
      bits &= bits - 1u;
      if (is_active(load_triangle(args.triangles, word * 32u + bit))) ++appeared;
    }
  }
  appeared = subgroupAdd(appeared);
  if (subgroupElect() && appeared != 0u) atomicAdd(args.refit.at[0].appeared_count, appeared);  // partners: all others
}
