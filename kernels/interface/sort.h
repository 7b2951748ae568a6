// LSD radix sort of (key, value) pairs, 8-bit digits; keys of one or two words, low word first.
#ifndef COPPICE_INTERFACE_SORT_H
#define COPPICE_INTERFACE_SORT_H
#include "types.h"
INTERFACE_BEGIN

const uint SORT_DIGIT_BITS = 8;
const uint SORT_DIGITS = 256;
const uint SORT_PASSES_PER_WORD = 4;

// One invocation counts a run of consecutive keys into a row of its own, two 16-bit counters a word.
const uint SORT_HISTOGRAM_GROUP = 8;
const uint SORT_HISTOGRAM_RUN = 2048;
const uint SORT_HISTOGRAM_TILE = SORT_HISTOGRAM_GROUP * SORT_HISTOGRAM_RUN;
const uint SORT_HISTOGRAM_ROW = SORT_PASSES_PER_WORD * SORT_DIGITS / 2;

// One invocation ranks a run of consecutive keys serially: stable, and the fastest on CPU devices.
const uint SORT_GROUP = 16;
const uint SORT_RUN = 1024;
const uint SORT_TILE = SORT_GROUP * SORT_RUN;

struct SortHistogramArgs {
  UintBuffer keys;       // count * key_words
  UintBuffer histogram;  // key_words * 4 * SORT_DIGITS, zero at the start
  uint count;
  uint key_words;
};

struct SortDigitScanArgs {
  UintBuffer histogram;  // passes * SORT_DIGITS counts, replaced by their exclusive sums within each pass
  uint pass_count;
  uint padding;
};

// Shared by the passes and, without lookback, by the kernel that counts a tile's digits.
struct SortPassArgs {
  UintBuffer keys_in, values_in;  // keys alone have no values: null
  UintBuffer keys_out, values_out;
  UintBuffer digit_offsets;        // SORT_DIGITS, of this pass
  CoherentUintBuffer tile_status;  // tiles * SORT_DIGITS: lookback words; without lookback, digit counts,
                                   // then their prefixes
  CoherentUintBuffer ticket;       // one word
  BuildStateBuffer state;          // error word
  uint count;
  uint key_words;
  uint pass;
  uint lookback;  // 1: tile prefixes by lookback; 0: from sort_tile_counts and sort_tile_scan
};

struct SortTileScanArgs {
  CoherentUintBuffer tile_status;  // tiles * SORT_DIGITS counts, replaced by exclusive sums over the tiles
  uint tile_count;
  uint padding;
};

INTERFACE_END
#endif
