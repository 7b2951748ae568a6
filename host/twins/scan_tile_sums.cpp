#include "interface/scan.h"
#include "twins/device_count.h"

namespace coppice::twins {

void scan_tile_sums(const ScanTileSumsArgs& args) {
  constexpr uint tile_words = SCAN_TILE * 4;
  const uint count = counted(args.count_at, args.word_count);
  for (uint first = 0; first < count; first += tile_words) {
    uint sum = 0;
    for (uint i = first; i < first + tile_words && i < count; ++i) sum += args.source[i / 4][i % 4];
    args.tile_sums[first / tile_words] = sum;
  }
}

}  // namespace coppice::twins
