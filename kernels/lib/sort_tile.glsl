// The digits of one tile of Onesweep: counted into rows of counters, each over consecutive keys. A row belongs to an
// invocation, which takes its keys one by one, or to a subgroup, which takes a key an invocation at a time.
//
// The including kernel defines `key_count`.

layout(constant_id = 3) const bool RANK_BY_MATCH = false;
layout(constant_id = 4) const uint GROUP = SORT_RUNS_GROUP;

const uint ROWS = RANK_BY_MATCH ? GROUP / LANES : GROUP;
const uint STRIDE = RANK_BY_MATCH ? LANES : 1u;

shared uint digit_rows[SORT_MAX_ROWS * SORT_DIGITS];

uint row() { return RANK_BY_MATCH ? gl_SubgroupID : gl_LocalInvocationIndex; }

uint digit_of(uint key_index) {
  uint word = args.keys_in.at[key_index * args.key_words + args.pass / SORT_PASSES_PER_WORD];
  return bitfieldExtract(word, int((args.pass % SORT_PASSES_PER_WORD) * SORT_DIGIT_BITS), int(SORT_DIGIT_BITS));
}

// The keys of this invocation's row in a tile: from x to y - 1, as far as they are below key_count. All rows go through
// as many turns as the first, since some drivers take a barrier of a subgroup for one of the workgroup.
uvec2 run_of(uint tile) {
  uint tile_first = tile * args.tile_keys, run = args.tile_keys / ROWS;
  uint first = tile_first + row() * run;
  return uvec2(first, first + min(run, key_count - tile_first));
}

// Between accesses of a subgroup's invocations to its row.
void sync_row() {
  if (RANK_BY_MATCH) sync();
}

// The place of the invocation's key by the row's counter of its digit, which is moved on. All of the row's invocations
// at once; those without a key give the digit SORT_DIGITS.
uint take_place(uint digit) {
  Match same = Match(0u, true);
  if (RANK_BY_MATCH) same = match_by_ballot(digit, SORT_DIGIT_BITS);
  uint counter = row() * SORT_DIGITS + min(digit, SORT_DIGITS - 1u);
  uint place = digit_rows[counter] + same.before;
  sync_row();
  if (digit < SORT_DIGITS && same.is_last) digit_rows[counter] = place + 1u;
  sync_row();
  return place;
}

// The whole workgroup; ends with a barrier.
void count_rows(uint tile) {
  [[dont_unroll]] for (uint i = gl_LocalInvocationIndex; i < ROWS * SORT_DIGITS; i += GROUP) digit_rows[i] = 0u;
  barrier();
  uint first_key = RANK_BY_MATCH ? lane() : 0u;
  uvec2 run = run_of(tile);
  [[dont_unroll]] for (uint first = run.x; first < run.y; first += STRIDE) {
    uint i = first + first_key;
    take_place(i < key_count ? digit_of(i) : SORT_DIGITS);
  }
  barrier();
}

uint sum_of_rows(uint digit) {
  uint sum = 0u;
  [[dont_unroll]] for (uint r = 0u; r < ROWS; ++r) sum += digit_rows[r * SORT_DIGITS + digit];
  return sum;
}
