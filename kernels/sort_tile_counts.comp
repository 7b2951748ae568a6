// In:  keys. Out: how often each digit of this pass occurs in each tile.
// Merrill and Grimshaw 2011, "High Performance and Scalable Radix Sorting", section 4.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { SortScatterArgs args; };

#include "lib/subgroup_match.glsl"
#include "lib/sort_counters.glsl"

void clear_counters() {
  [[dont_unroll]] for (uint digit = lane(); digit < DIGITS; digit += SUBGROUP_SIZE) set_counter(digit, 0u);
  sync();
}

void count_digit(uint digit) {
  Match same = match_digit(digit, DIGIT_BITS);
  if (digit < DIGITS && same.is_last) set_counter(digit, counter(digit) + same.before + 1u);
  sync();
}

void main() {
  clear_counters();
  uvec2 places = places_of_tile();
  [[dont_unroll]] for (uint first = places.x; first < places.y; first += 2u * SUBGROUP_SIZE) {
    uvec2 at = first + lane() + uvec2(0u, SUBGROUP_SIZE);
    uvec2 read = min(at, uvec2(places.y - 1u));
    uint even = key_word(read.x, args.digit_word), odd = key_word(read.y, args.digit_word);
    count_digit(at.x < places.y ? digit_of(even) : DIGITS);
    count_digit(at.y < places.y ? digit_of(odd) : DIGITS);
  }
  store_counters();
}
