// LSD radix sort of (key, value) pairs; keys of one or two words, low word first. Two ways to the same order:
// Onesweep (sort_histogram, sort_digit_scan and a sort_pass a digit), whose tiles get their prefixes by
// lookback, and counting, scanning and scattering (sort_tile_counts, sort_tile_scan and sort_scatter a
// digit), which never wait.
//
// `count_at` is null, or where the device has the number of keys, of which at most `count` are sorted. What
// lies behind them is not touched.
#ifndef COPPICE_INTERFACE_SORT_H
#define COPPICE_INTERFACE_SORT_H
#include "lookback.h"
INTERFACE_BEGIN

// Of Onesweep.
const uint SORT_DIGIT_BITS = 8;
const uint SORT_DIGITS = 256;
const uint SORT_PASSES_PER_WORD = 4;

// One invocation counts a run of consecutive keys into a row of its own, two 16-bit counters a word.
const uint SORT_HISTOGRAM_GROUP = 8;
const uint SORT_HISTOGRAM_RUN = 2048;
const uint SORT_HISTOGRAM_TILE = SORT_HISTOGRAM_GROUP * SORT_HISTOGRAM_RUN;
const uint SORT_HISTOGRAM_ROW = SORT_PASSES_PER_WORD * SORT_DIGITS / 2;

// A pass ranks the keys of a tile in rows of counters, consecutive keys in each. Either an invocation has a
// row, and ranks its keys one by one; or a subgroup has one, and ranks as many keys at once as it has
// invocations.
const uint SORT_MAX_ROWS = 16;
const uint SORT_RUNS_GROUP = 16;
const uint SORT_RUNS_TILE = 16384;
const uint SORT_MATCH_GROUP = 64;  // at least 4 to a subgroup, so at most SORT_MAX_ROWS
const uint SORT_MATCH_TILE = 4096;

// Of counting, scanning and scattering: the digits have 8 or 11 bits, and a tile, which one subgroup takes,
// at least SORT_SCAN_TILE keys. Where there is but one tile, sort_scatter counts and scans for itself.
const uint SORT_NARROW_BITS = 8;
const uint SORT_WIDE_BITS = 11;
const uint SORT_SCAN_TILE = 16384;
const uint SORT_TILE_SCAN_GROUP = 256;

struct SortHistogramArgs {
  READS(UintBuffer) keys;  // count * key_words
  UintBuffer histogram;    // key_words * 4 * SORT_DIGITS, zero at the start
  READS(UintBuffer) count_at;
  uint count;
  uint key_words;
};

struct SortDigitScanArgs {
  UintBuffer histogram;  // passes * SORT_DIGITS counts, replaced by their exclusive sums within each pass
  uint pass_count;
  uint padding;
};

struct SortPassArgs {
  READS(UintBuffer) keys_in, values_in;  // keys alone have no values: null
  UintBuffer keys_out, values_out;
  READS(UintBuffer) digit_offsets;  // SORT_DIGITS, of this pass
  CoherentUintBuffer tile_status;   // tiles * SORT_DIGITS lookback words
  CoherentUintBuffer ticket;        // one word
  BuildStateBuffer state;           // primitive_count and error word
  READS(UintBuffer) count_at;
  uint count;
  uint key_words;
  uint pass;
  uint tile_keys;  // SORT_RUNS_TILE or SORT_MATCH_TILE
};

// Shared by counting and scattering. The digit is that of `digit_bits` bits from bit `digit_shift` of the
// key's `digit_word`-th word; above bit 31 there are zeroes.
struct SortScatterArgs {
  READS(UintBuffer) keys_in, values_in;
  UintBuffer keys_out, values_out;
  // tiles << digit_bits. sort_tile_counts leaves counts, sort_tile_scan where the first key of each tile and
  // digit goes, sort_scatter where one more would go.
  UintBuffer tile_digits;
  BuildStateBuffer state;  // primitive_count and error word; written by sort_scatter
  READS(UintBuffer) count_at;
  uint count;
  uint key_words;
  uint digit_word, digit_shift, digit_bits;
  uint tile_keys;
};

struct SortTileScanArgs {
  UintBuffer tile_digits;  // tiles << digit_bits counts, replaced by exclusive sums over (digit, tile)
  READS(UintBuffer) count_at;
  uint count;
  uint tile_keys;
  uint digit_bits;
  uint padding;
};

// Specialization constants; what is an argument, too, has the same value there.
struct SortPassConstants {
  LookbackConstants lookback;
  uint rank_by_match;
  uint group;       // invocations of a workgroup
  uint has_values;  // 0: of keys alone
};

struct SortTileScanConstants {
  uint digit_bits;
};

struct SortTileConstants {
  uint digit_bits;
  uint key_words;
};

struct SortScatterConstants {
  SortTileConstants tile;
  uint has_values;
  uint one_tile;  // count <= tile_keys: it counts and scans for itself
};

INTERFACE_END
#endif
