#include "interface/ploc.h"
#include "twins/ploc_rounds.h"

namespace coppice::twins {

void ploc_leaves(const PlocLeavesArgs& args) {
  const uint active_count = args.state[0].active_count;
  args.rounds[0] = make_round(active_count, 0, false);
  for (uint i = 0; i < active_count; ++i) {
    const uint triangle = args.values[i];
    args.clusters[i] = {args.boxes[triangle].box_min, triangle, args.boxes[triangle].box_max, 0};
  }
}

}  // namespace coppice::twins
