#include "interface/wide.h"

namespace coppice::twins {

void wide_collapse(const WideCollapseArgs& args);

void wide_collapse_rest(const WideCollapseRestArgs& args) {
  for (uint level = args.level; level < args.level_limit && args.levels[level].count != 0; ++level) {
    wide_collapse({args.nodes, args.entries, args.children, args.tile_sums, args.block_sums, args.levels,
                   args.counts, args.state, level, 0});
  }
}

}  // namespace coppice::twins
