#include "twins/refit_box.h"

namespace coppice::twins {

void refit_rest(const RefitRestArgs& args) {
  if (args.state[0].active_count == 1) refit_leaf(args.nodes[0], args.triangles);
  for (uint level = args.level; args.levels[level].count != 0; ++level) {
    const RefitLevel& its = args.levels[level];
    for (uint i = its.first; i < its.first + its.count; ++i)
      refit_node(args.nodes, args.triangles, args.order[i]);
  }
}

}  // namespace coppice::twins
