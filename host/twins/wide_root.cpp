#include "twins/wide_levels.h"

namespace coppice::twins {

void wide_root(const WideCollapseArgs& args) {
  if (args.state[0].active_count == 0) return;
  if (args.nodes[0].height > WIDE_MAX_HEIGHT) {
    args.state[0].error_word |= ERROR_WIDE_TOO_DEEP;
    return;
  }
  args.levels[0] = make_level(0, 1, 0, 0);
  enter_wide_node(args, args.levels[0], 0, 0, 0);
}

}  // namespace coppice::twins
