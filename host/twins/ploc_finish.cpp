#include <algorithm>
#include <vector>

#include "interface/ploc.h"
#include "twins/ploc_rounds.h"

namespace coppice::twins {

void ploc_finish(const PlocFinishArgs& args) {
  BuildState& state = args.state[0];
  uint index = 0;
  while (args.rounds[index].merge_groups.x != 0 && index < args.rounds_bound) ++index;
  const NodeBuffer in = index % 2 == 0 ? args.clusters_even : args.clusters_odd;
  std::vector<Node> clusters(&in[0], &in[0] + args.rounds[index].cluster_count);

  for (; clusters.size() > 1 && index < args.rounds_bound; ++index) {
    const PlocRound& round = args.rounds[index];
    const std::vector<uint> nearest =
        find_neighbours(clusters, round.pair_all, args.radius, Normalisation(state));
    std::vector<Node> next;
    uint merged = 0;
    for (uint i = 0; i < clusters.size(); ++i) {
      const uint j = nearest[i];
      if (j == i || nearest[j] != i) {
        next.push_back(clusters[i]);
      } else if (i < j) {
        const uint children = children_place(state.active_count, round.merged_before + merged++);
        args.nodes[children] = clusters[i];
        args.nodes[children + 1] = clusters[j];
        next.push_back(make_parent(clusters[i], clusters[j], children));
      }
    }
    clusters = std::move(next);
    args.rounds[index + 1] = round_after(index, round, merged);
  }
  state.round_count = index;
  if (clusters.size() != std::min(state.active_count, 1u)) state.error_word |= ERROR_PLOC_ROUNDS;
  if (state.error_word != 0) state.active_count = 0;
  if (clusters.size() == 1) args.nodes[0] = clusters[0];
}

}  // namespace coppice::twins
