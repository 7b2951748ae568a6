#include <utility>

#include "interface/ploc.h"

namespace coppice::twins {

void ploc_tile_scan(const PlocTileScanArgs& args) {
  const std::size_t words = std::size_t{args.rounds[args.round].merge_groups.x} * PLOC_MERGE_SUMS;
  uint sums[PLOC_MERGE_SUMS] = {};
  for (std::size_t i = 0; i < words; ++i) {
    uint& sum = sums[i % PLOC_MERGE_SUMS];
    sum += std::exchange(args.tile_status[i], sum);
  }
}

}  // namespace coppice::twins
