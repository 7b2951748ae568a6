// How tests make lookback hard: bits of the kernels' constant LOOKBACK_STRESS. No sum depends on them.
#ifndef COPPICE_INTERFACE_LOOKBACK_H
#define COPPICE_INTERFACE_LOOKBACK_H
#include "types.h"
INTERFACE_BEGIN

// Of so many neighbouring tiles the last starts first, so that it meets none that has reported.
const uint LOOKBACK_REVERSED = 1;
const uint LOOKBACK_REVERSED_TILES = 16;

// By a hash of tile and sum, the aggregate is left out, the inclusive prefix, both or neither.
const uint LOOKBACK_WITHHELD = 2;

// The upper bits: the tiles 1 to LOOKBACK_STRESS >> LOOKBACK_SILENT_SHIFT never report, neither their own
// sums nor those that they found for others.
const uint LOOKBACK_SILENT_SHIFT = 8;

// Specialization constants of kernels with lookback, before their own.
struct LookbackConstants {
  uint turns;          // of LOOKBACK_POLLS polls each, before a tile sums up its predecessor itself
  uint max_fallbacks;  // a tile that would have to sum up more of them gives up
  uint stress;         // bits as above
};

INTERFACE_END
#endif
