// In:  the triangles that a tree was built over. Out: a bit for each that is in no leaf. Where all are in leaves nothing is
// read or written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/refit.h"

layout(local_size_x = REFIT_ABSENT_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitAbsentArgs args; };

#include "lib/refit_absent.glsl"
#include "lib/refit_box.glsl"

void main() {
  uint count = absent_limit();
  uint word = gl_GlobalInvocationID.x;
  if (word * 32u >= count) return;
  uint bits = 0u, last = min(count - word * 32u, 32u);
  [[dont_unroll]] for (uint bit = 0u; bit < last; ++bit)
    if (!is_active(load_triangle(args.triangles, word * 32u + bit))) bits |= 1u << bit;
  args.absent.at[word] = bits;
}
