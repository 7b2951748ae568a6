// In:  pairs, sorted by the digits below this one; where the first key of each tile and digit goes, which a tile without
// others finds itself. Out: pairs sorted by this digit too; the sort is stable.
// Merrill and Grimshaw 2011, "High Performance and Scalable Radix Sorting", section 4; ranks by subgroup match, as in
// Adinets and Merrill 2022, "Onesweep", section 4.4.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { SortScatterArgs args; };
layout(constant_id = 2) const bool HAS_VALUES = true;  // false: of keys alone
layout(constant_id = 3) const bool ONE_TILE = false;   // args.count <= args.tile_keys

#include "lib/subgroup_match.glsl"
#include "lib/count_error.glsl"
#include "lib/sort_counters.glsl"

struct Pair {
  uvec2 key;  // the upper word only of keys of two
  uint value;
};

Pair load_pair(uint place) {
  uint upper = KEY_WORDS == 2u ? key_word(place, 1u) : 0u;
  return Pair(uvec2(key_word(place, 0u), upper), HAS_VALUES ? args.values_in.at[place] : 0u);
}

void store_pair(uint place, Pair pair) {
  args.keys_out.at[place * KEY_WORDS] = pair.key.x;
  if (KEY_WORDS == 2u) args.keys_out.at[place * 2u + 1u] = pair.key.y;
  if (HAS_VALUES) args.values_out.at[place] = pair.value;
}

void load_counters() {
  if (LANES_IN_STEP) return;
  for (uint digit = lane(); digit < DIGITS; digit += LANES)
    digit_counters[digit] = args.tile_digits.at[first_counter() + digit];
  sync();
}

// Of one tile: exclusive sums of its counts.
void scan_counters() {
  uint before = 0u;
  [[dont_unroll]] for (uint first = 0u; first < DIGITS; first += LANES) {
    uint count = counter(first + lane());
    set_counter(first + lane(), before + subgroupExclusiveAdd(count));
    before += subgroupAdd(count);
  }
  sync();
}

void scatter(Pair pair, bool exists) {
  uint digit = exists ? digit_of(KEY_WORDS == 2u && args.digit_word == 1u ? pair.key.y : pair.key.x) : DIGITS;
  Match same = match_digit(digit, DIGIT_BITS);
  uint place = exists ? counter(digit) + same.before : 0u;
  sync();
  if (exists && same.is_last) set_counter(digit, place + 1u);
  if (exists) store_pair(place, pair);
  sync();
}

void main() {
  if (gl_GlobalInvocationID.x == 0u) note_count(args.state, args.count_at, args.count);
  uvec2 places = places_of_tile();
  if (places.y == 0u) return;
  if (ONE_TILE) {
    count_tile(places);
    scan_counters();
  } else {
    load_counters();
  }
  [[dont_unroll]] for (uint first = places.x; first < places.y; first += 2u * LANES) {
    uvec2 at = first + lane() + uvec2(0u, LANES);
    uvec2 read = min(at, uvec2(places.y - 1u));
    Pair even = load_pair(read.x), odd = load_pair(read.y);
    scatter(even, at.x < places.y);
    scatter(odd, at.y < places.y);
  }
  store_counters();
}
