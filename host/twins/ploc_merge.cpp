#include <algorithm>
#include <array>
#include <vector>

#include "interface/ploc.h"
#include "twins/lookback_words.h"
#include "twins/ploc_rounds.h"

namespace coppice::twins {

void ploc_merge(const PlocMergeArgs& args) {
  PlocRound& round = args.rounds[args.round];
  const uint active_count = args.state[0].active_count;
  const std::vector<uint> nearest = find_neighbours(
      {&args.clusters_in[0], round.cluster_count}, round.pair_all, args.radius, Normalisation(args.state[0]));
  std::fill_n(&args.next_status[0], std::size_t{round.merge_groups.x} * PLOC_MERGE_SUMS, 0u);
  std::array<uint, PLOC_MERGE_SUMS> prefix{};  // retired, merged
  for (uint i = 0; i < round.cluster_count; ++i) {
    const uint j = nearest[i];
    const bool mutual = j != i && nearest[j] == i;
    args.partners[i] = !mutual ? i : j < i ? PLOC_RETIRES : j;
    if (mutual && j < i) {
      ++prefix[0];
    } else {
      Node& place = args.clusters_out[i - prefix[0]];
      place = args.clusters_in[i];
      if (mutual) {
        const uint children = children_place(active_count, round.merged_before + prefix[1]++);
        args.nodes[children] = args.clusters_in[i];
        args.nodes[children + 1] = args.clusters_in[j];
        place = make_parent(args.clusters_in[i], args.clusters_in[j], children);
      }
    }
    const bool ends_tile = (i + 1) % PLOC_MERGE_TILE == 0 || i + 1 == round.cluster_count;
    if (args.lookback && ends_tile) {
      leave_inclusive_prefix(args.tile_status, i / PLOC_MERGE_TILE, prefix);
      ++round.ticket;
    }
  }
  args.rounds[args.round + 1] = round_after(args.round, round, prefix[0]);
}

}  // namespace coppice::twins
