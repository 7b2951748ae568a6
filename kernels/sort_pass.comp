// In:  pairs, sorted by the digits below this one; where each digit's first key goes. Out: pairs sorted by this digit
// too; the sort is stable. Adinets and Merrill 2022, "Onesweep": one reading and one writing a digit, tile prefixes by
// decoupled lookback. Without lookback the prefixes come from sort_tile_counts and sort_tile_scan.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { SortPassArgs args; };
layout(constant_id = 3) const uint SORT_HAS_VALUES = 1u;

#include "lib/sort_tile.glsl"
#define LOOKBACK_GROUP SORT_GROUP
#define LOOKBACK_SUMS SORT_DIGITS
void sum_tile(uint tile);
#include "lib/lookback.glsl"

shared uint ticket;

void sum_tile(uint tile) {
  count_rows(tile);
  [[dont_unroll]] for (uint digit = gl_LocalInvocationIndex; digit < SORT_DIGITS; digit += SORT_GROUP)
    tile_sums[digit] = sum_of_rows(digit);
  barrier();
}

// Where the keys of each digit before this tile end; false if that cannot be known.
bool find_tile_prefix(uint tile) {
  sum_tile(tile);
  if (args.lookback == 0u) {
    [[dont_unroll]] for (uint digit = gl_LocalInvocationIndex; digit < SORT_DIGITS; digit += SORT_GROUP)
      lookback_prefix[digit] = args.tile_status.at[tile * SORT_DIGITS + digit];
    return true;
  }
  uint fallbacks = lookback(args.tile_status, tile);
  if (fallbacks > LOOKBACK_MAX_FALLBACKS) return false;
  if (fallbacks > 0u) count_rows(tile);
  return true;
}

// Turns the counts of the rows into the place where each row's first key with that digit goes.
void scan_rows() {
  [[dont_unroll]] for (uint digit = gl_LocalInvocationIndex; digit < SORT_DIGITS; digit += SORT_GROUP) {
    uint place = args.digit_offsets.at[digit] + lookback_prefix[digit];
    [[dont_unroll]] for (uint row = 0u; row < SORT_GROUP; ++row) {
      uint row_count = digit_rows[row * SORT_DIGITS + digit];
      digit_rows[row * SORT_DIGITS + digit] = place;
      place += row_count;
    }
  }
  barrier();
}

void scatter(uint tile) {
  uint row = gl_LocalInvocationIndex * SORT_DIGITS;
  uvec2 run = run_of(tile);
  [[dont_unroll]] for (uint i = run.x; i < run.y; ++i) {
    uint counter = row + digit_of(i);
    uint place = digit_rows[counter];
    digit_rows[counter] = place + 1u;
    for (uint word = 0u; word < args.key_words; ++word)
      args.keys_out.at[place * args.key_words + word] = args.keys_in.at[i * args.key_words + word];
    if (SORT_HAS_VALUES != 0u) args.values_out.at[place] = args.values_in.at[i];
  }
}

void main() {
  uint tile = gl_WorkGroupID.x;
  if (args.lookback != 0u) {
    // Partners: the workgroups of this pass. The order of tickets is an order in which tiles have started.
    if (gl_LocalInvocationIndex == 0u) ticket = atomicAdd(args.ticket.at[0], 1u);
    barrier();
    tile = started_tile(ticket, gl_NumWorkGroups.x);
  }
  if (!find_tile_prefix(tile)) {
    if (gl_LocalInvocationIndex == 0u) atomicOr(args.state.at[0].error_word, ERROR_SORT_LOOKBACK);
    return;
  }
  scan_rows();
  scatter(tile);
}
