#include "interface/refit.h"

namespace coppice::twins {

void refit_keys(const RefitKeysArgs& args) {
  args.pair_count[0] = 0;
  const uint leaves = args.state[0].active_count;
  if (leaves == 0) return;
  if (args.nodes[0].height > REFIT_MAX_HEIGHT) {
    args.state[0].error_word |= ERROR_REFIT_TOO_DEEP;
    return;
  }
  args.pair_count[0] = leaves - 1;
  for (uint i = 0; i < 2 * leaves - 1; ++i) {
    const Node& node = args.nodes[i];
    if (node.height == 0) continue;
    const bool left_leaf = args.nodes[node.child].height == 0;
    const bool right_leaf = args.nodes[node.child + 1].height == 0;
    const uint kind = left_leaf ? (right_leaf ? REFIT_TWO_LEAVES : REFIT_LEFT_LEAF)
                                : (right_leaf ? REFIT_RIGHT_LEAF : REFIT_NO_LEAF);
    args.keys[node.child / 2] = 4 * (node.height - 1) + kind;  // the first child's place is odd
    args.parents[node.child / 2] = i;
  }
}

}  // namespace coppice::twins
