#include <algorithm>
#include <vector>

#include "interface/ploc.h"
#include "twins/ploc_rounds.h"

namespace coppice::twins {

void ploc_tile_counts(const PlocMergeArgs& args) {
  const PlocRound& round = args.rounds[args.round];
  const std::vector<uint> nearest = find_neighbours(
      {&args.clusters_in[0], round.cluster_count}, round.pair_all, args.radius, Normalisation(args.state[0]));
  std::fill_n(&args.tile_status[0], std::size_t{round.merge_groups.x} * PLOC_MERGE_SUMS, 0u);
  for (uint i = 0; i < round.cluster_count; ++i) {
    const uint j = nearest[i];
    args.partners[i] = i;
    if (j == i || nearest[j] != i) continue;
    args.partners[i] = j < i ? PLOC_RETIRES : j;
    const uint sum = j < i ? 0 : 1;
    ++args.tile_status[std::size_t{i / PLOC_MERGE_TILE} * PLOC_MERGE_SUMS + sum];
  }
}

}  // namespace coppice::twins
