// Exclusive prefix sums of a list of words, modulo 2^32.
//
// `count_at` is null, or where the device has the number of words, of which at most `word_count` are scanned.
// The last quad may be incomplete: what lies behind the last word is not touched.
#ifndef COPPICE_INTERFACE_SCAN_H
#define COPPICE_INTERFACE_SCAN_H
#include "copy.h"
#include "lookback.h"
INTERFACE_BEGIN

// One invocation sums, and then scans, a run of consecutive quads of words serially: the fastest on CPU
// devices.
const uint SCAN_GROUP = 16;
const uint SCAN_RUN = 256;
const uint SCAN_TILE = SCAN_GROUP * SCAN_RUN;  // quads

// A lookback word holds 30 bits, so tiles hand over two sums: of the lower and of the upper halves of the
// tiles' sums.
const uint SCAN_SUMS = 2;
const uint SCAN_HALF_BITS = 16;
// So that those sums fit, and the tiles' sums are one tile themselves.
const uint SCAN_MAX_TILES = 1 << (30 - SCAN_HALF_BITS);

struct PrefixScanArgs {
  READS(WordQuadBuffer) source;  // word_count
  WordQuadBuffer target;         // word_count; without lookback it may be the source
  CoherentUintBuffer
      tile_status;            // lookback: tiles * SCAN_SUMS words of it; else the exclusive sums of the tiles
  CoherentUintBuffer ticket;  // one word
  BuildStateBuffer state;     // primitive_count and error word
  READS(UintBuffer) count_at;
  uint word_count;
  uint lookback;  // 1: tile prefixes by lookback; 0: from scan_tile_sums and a scan of them
};

struct ScanTileSumsArgs {
  READS(WordQuadBuffer) source;  // word_count
  UintBuffer tile_sums;          // tiles
  READS(UintBuffer) count_at;
  uint word_count;
  uint padding;
};

INTERFACE_END
#endif
