#include <algorithm>

#include "interface/ploc.h"

namespace coppice::twins {

void ploc_tile_counts(const PlocMergeArgs& args) {
  const PlocRound& round = args.rounds[args.round];
  std::fill_n(&args.tile_status[0], std::size_t{round.merge_groups.x} * PLOC_MERGE_SUMS, 0u);
  for (uint i = 0; i < round.cluster_count; ++i) {
    const uint j = args.nearest[i];
    if (j == i || args.nearest[j] != i) continue;
    const uint sum = j < i ? 0 : 1;
    ++args.tile_status[std::size_t{i / PLOC_MERGE_TILE} * PLOC_MERGE_SUMS + sum];
  }
}

}  // namespace coppice::twins
