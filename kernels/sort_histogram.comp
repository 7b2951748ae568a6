// In:  keys. Out: how often each digit occurs in them, for all digits of the key in one reading.
// Adinets and Merrill 2022, "Onesweep", section 3.1. Each invocation counts a run of consecutive keys into a row of
// its own, so no counter is shared; rows are added once a workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"
#include "lib/device_count.glsl"

layout(local_size_x = SORT_HISTOGRAM_GROUP) in;
layout(push_constant, scalar) uniform Push { SortHistogramArgs args; };

shared uint rows[SORT_HISTOGRAM_GROUP][SORT_HISTOGRAM_ROW];

void count_digit(uint lane, uint counter) {
  rows[lane][counter >> 1] += 1u << ((counter & 1u) * 16u);
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint word = gl_WorkGroupID.y;
  uint count = counted(args.count_at, args.count);
  if (gl_WorkGroupID.x * SORT_HISTOGRAM_TILE >= count) return;
  [[dont_unroll]] for (uint i = 0u; i < SORT_HISTOGRAM_ROW; ++i) rows[lane][i] = 0u;

  uint first = gl_WorkGroupID.x * SORT_HISTOGRAM_TILE + lane * SORT_HISTOGRAM_RUN;
  uint last = min(first + SORT_HISTOGRAM_RUN, count);
  [[dont_unroll]] for (uint i = first; i < last; ++i) {
    uint key = args.keys.at[i * args.key_words + word];
    count_digit(lane, key & 255u);
    count_digit(lane, SORT_DIGITS + ((key >> 8) & 255u));
    count_digit(lane, 2u * SORT_DIGITS + ((key >> 16) & 255u));
    count_digit(lane, 3u * SORT_DIGITS + (key >> 24));
  }
  barrier();

  [[dont_unroll]] for (uint i = lane; i < SORT_HISTOGRAM_ROW; i += SORT_HISTOGRAM_GROUP) {
    uint even = 0u, odd = 0u;
    [[dont_unroll]] for (uint row = 0u; row < SORT_HISTOGRAM_GROUP; ++row) {
      even += rows[row][i] & 0xffffu;
      odd += rows[row][i] >> 16;
    }
    uint target = word * SORT_PASSES_PER_WORD * SORT_DIGITS + 2u * i;  // partners: the other workgroups
    if (even != 0u) atomicAdd(args.histogram.at[target], even);
    if (odd != 0u) atomicAdd(args.histogram.at[target + 1u], odd);
  }
}
