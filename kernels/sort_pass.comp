// In:  pairs, sorted by the digits below this one; where each digit's first key goes. Out: pairs sorted by this digit
// too; the sort is stable. Adinets and Merrill 2022, "Onesweep": one reading and one writing a digit, tile prefixes by
// decoupled lookback.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"
#include "lib/count_error.glsl"

layout(local_size_x_id = 4) in;
layout(push_constant, scalar) uniform Push { SortPassArgs args; };
layout(constant_id = 5) const bool HAS_VALUES = true;  // false: of keys alone

uint key_count;

#include "lib/subgroup_match.glsl"
#include "lib/sort_tile.glsl"
#define LOOKBACK_GROUP GROUP
#define LOOKBACK_SUMS SORT_DIGITS
void sum_tile(uint tile);
#include "lib/lookback.glsl"

shared uint ticket;

void sum_tile(uint tile) {
  count_rows(tile);
  [[dont_unroll]] for (uint digit = gl_LocalInvocationIndex; digit < SORT_DIGITS; digit += GROUP)
    tile_sums[digit] = sum_of_rows(digit);
  barrier();
}

// Where the keys of each digit before this tile end; false if that cannot be known.
bool find_tile_prefix(uint tile) {
  sum_tile(tile);
  uint fallbacks = lookback(args.tile_status, tile);
  if (fallbacks > LOOKBACK_MAX_FALLBACKS) return false;
  if (fallbacks > 0u) count_rows(tile);
  return true;
}

// Turns the counts of the rows into the place where each row's first key with that digit goes.
void scan_rows() {
  [[dont_unroll]] for (uint digit = gl_LocalInvocationIndex; digit < SORT_DIGITS; digit += GROUP) {
    uint place = args.digit_offsets.at[digit] + lookback_prefix[digit];
    [[dont_unroll]] for (uint r = 0u; r < ROWS; ++r) {
      uint row_count = digit_rows[r * SORT_DIGITS + digit];
      digit_rows[r * SORT_DIGITS + digit] = place;
      place += row_count;
    }
  }
  barrier();
}

void scatter(uint tile) {
  uint lane = RANK_BY_MATCH ? gl_SubgroupInvocationID : 0u;
  uvec2 run = run_of(tile);
  [[dont_unroll]] for (uint first = run.x; first < run.y; first += STRIDE) {
    uint i = first + lane;
    uint place = take_place(i < key_count ? digit_of(i) : SORT_DIGITS);
    if (i < key_count) {
      for (uint word = 0u; word < args.key_words; ++word)
        args.keys_out.at[place * args.key_words + word] = args.keys_in.at[i * args.key_words + word];
      if (HAS_VALUES) args.values_out.at[place] = args.values_in.at[i];
    }
  }
}

void main() {
  // Partners: the workgroups of this pass. The order of tickets is an order in which tiles have started.
  if (gl_LocalInvocationIndex == 0u) ticket = atomicAdd(args.ticket.at[0], 1u);
  barrier();
  uint tile = started_tile(ticket, gl_NumWorkGroups.x);
  key_count = counted(args.count_at, args.count);
  if (tile == 0u && gl_LocalInvocationIndex == 0u) note_count(args.state, args.count_at, args.count);
  if (tile * args.tile_keys >= key_count) return;
  if (!find_tile_prefix(tile)) {
    if (gl_LocalInvocationIndex == 0u) atomicOr(args.state.at[0].error_word, ERROR_SORT_LOOKBACK);
    return;
  }
  scan_rows();
  scatter(tile);
}
