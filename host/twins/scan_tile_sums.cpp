#include "interface/scan.h"

namespace coppice::twins {

void scan_tile_sums(const ScanTileSumsArgs& args) {
  for (uint first = 0; first < args.quad_count; first += SCAN_TILE) {
    uint sum = 0;
    for (uint i = first; i < first + SCAN_TILE && i < args.quad_count; ++i) {
      const uvec4& words = args.source[i];
      sum += words.x + words.y + words.z + words.w;
    }
    args.tile_sums[first / SCAN_TILE] = sum;
  }
}

}  // namespace coppice::twins
