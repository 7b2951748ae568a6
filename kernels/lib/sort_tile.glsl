// The digits of one tile of the radix sort: each invocation counts a run of consecutive keys into a row of its own.

shared uint digit_rows[SORT_GROUP * SORT_DIGITS];

uint digit_of(uint key_index) {
  uint word = args.keys_in.at[key_index * args.key_words + args.pass / SORT_PASSES_PER_WORD];
  return bitfieldExtract(word, int((args.pass % SORT_PASSES_PER_WORD) * SORT_DIGIT_BITS), int(SORT_DIGIT_BITS));
}

uvec2 run_of(uint tile) {
  uint first = tile * SORT_TILE + gl_LocalInvocationIndex * SORT_RUN;
  return uvec2(first, min(first + SORT_RUN, args.count));
}

// The whole workgroup; ends with a barrier.
void count_rows(uint tile) {
  uint row = gl_LocalInvocationIndex * SORT_DIGITS;
  [[dont_unroll]] for (uint digit = 0u; digit < SORT_DIGITS; ++digit) digit_rows[row + digit] = 0u;
  uvec2 run = run_of(tile);
  [[dont_unroll]] for (uint i = run.x; i < run.y; ++i) ++digit_rows[row + digit_of(i)];
  barrier();
}

uint sum_of_rows(uint digit) {
  uint sum = 0u;
  [[dont_unroll]] for (uint row = 0u; row < SORT_GROUP; ++row) sum += digit_rows[row * SORT_DIGITS + digit];
  return sum;
}
