// A tile of the radix sort that one subgroup takes, as many keys at once as it has invocations, with a counter a digit.
// On CPU devices the counters stay in device memory, where gathers and scatters are single instructions.
//
// The including kernel includes lib/subgroup_match.glsl and lib/device_count.glsl before.

layout(constant_id = 0) const uint DIGIT_BITS = SORT_NARROW_BITS;  // args.digit_bits
layout(constant_id = 1) const uint KEY_WORDS = 1u;                 // args.key_words
const uint DIGITS = 1u << DIGIT_BITS;

shared uint digit_counters[DIGITS];

uint first_counter() { return gl_WorkGroupID.x << DIGIT_BITS; }

uint counter(uint digit) {
  if (LANES_IN_STEP) return args.tile_digits.at[first_counter() + digit];
  return digit_counters[digit];
}

void set_counter(uint digit, uint value) {
  if (LANES_IN_STEP) args.tile_digits.at[first_counter() + digit] = value;
  else digit_counters[digit] = value;
}

void store_counters() {
  if (LANES_IN_STEP) return;
  sync();
  for (uint digit = lane(); digit < DIGITS; digit += LANES)
    args.tile_digits.at[first_counter() + digit] = digit_counters[digit];
}

// Places from x to y - 1; none, and y = 0, behind the last key.
uvec2 places_of_tile() {
  uint first = gl_WorkGroupID.x * args.tile_keys, count = counted(args.count_at, args.count);
  return uvec2(first, first < count ? min(first + args.tile_keys, count) : 0u);
}

uint digit_of(uint key_word) { return (key_word >> args.digit_shift) & (DIGITS - 1u); }

uint key_word(uint place, uint word) { return args.keys_in.at[place * KEY_WORDS + word]; }

void count_digit(uint digit) {
  Match same = match_digit(digit, DIGIT_BITS);
  if (digit < DIGITS && same.is_last) set_counter(digit, counter(digit) + same.before + 1u);
  sync();
}

void count_tile(uvec2 places) {
  [[dont_unroll]] for (uint digit = lane(); digit < DIGITS; digit += LANES) set_counter(digit, 0u);
  sync();
  [[dont_unroll]] for (uint first = places.x; first < places.y; first += 2u * LANES) {
    uvec2 at = first + lane() + uvec2(0u, LANES);
    uvec2 read = min(at, uvec2(places.y - 1u));
    uint even = key_word(read.x, args.digit_word), odd = key_word(read.y, args.digit_word);
    count_digit(at.x < places.y ? digit_of(even) : DIGITS);
    count_digit(at.y < places.y ? digit_of(odd) : DIGITS);
  }
}
