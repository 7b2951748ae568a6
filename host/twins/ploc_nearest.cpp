#include <algorithm>
#include <vector>

#include "interface/ploc.h"
#include "twins/normalised.h"
#include "twins/ploc_rounds.h"

namespace coppice::twins {

void ploc_nearest(const PlocNearestArgs& args) {
  const PlocRound& round = args.rounds[args.round];
  std::fill_n(&args.tile_status[0], std::size_t{round.merge_groups.x} * PLOC_MERGE_SUMS, 0u);
  if (round.pair_all) {
    for (uint i = 0; i < round.cluster_count; ++i) args.nearest[i] = i % 2 ? i - 1 : i + 1;
    if (round.cluster_count % 2) args.nearest[round.cluster_count - 1] = round.cluster_count - 1;
    return;
  }
  const Normalisation normalise(args.state[0]);
  std::vector<Aabb> boxes(round.cluster_count);
  for (uint i = 0; i < round.cluster_count; ++i) {
    boxes[i] = {normalise(args.clusters[i].box_min), normalise(args.clusters[i].box_max)};
  }
  for (uint i = 0; i < round.cluster_count; ++i) {
    args.nearest[i] = nearest_neighbour(boxes.data(), i, round.cluster_count, args.radius);
  }
}

}  // namespace coppice::twins
