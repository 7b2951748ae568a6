// In:  digit histograms, one a pass. Out: their exclusive sums: where the first key with each digit goes.
// One workgroup a pass, one invocation a digit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"

layout(local_size_x = SORT_DIGITS) in;
layout(push_constant, scalar) uniform Push { SortDigitScanArgs args; };

shared uint sums[SORT_DIGITS];

void main() {
  uint digit = gl_LocalInvocationIndex;
  uint i = gl_WorkGroupID.x * SORT_DIGITS + digit;
  uint digit_count = args.histogram.at[i];
  sums[digit] = digit_count;
  barrier();
  [[dont_unroll]] for (uint distance = 1u; distance < SORT_DIGITS; distance *= 2u) {
    uint before = digit >= distance ? sums[digit - distance] : 0u;
    barrier();
    sums[digit] += before;
    barrier();
  }
  args.histogram.at[i] = sums[digit] - digit_count;
}
