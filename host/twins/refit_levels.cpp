#include "interface/refit.h"
#include "twins/wide_levels.h"

namespace coppice::twins {

void refit_levels(const RefitLevelsArgs& args) {
  uint first = 0;
  for (uint level = 0; level <= REFIT_MAX_HEIGHT; ++level) {
    uint last = first;
    while (last < args.pair_count[0] && args.heights[last] == level) ++last;
    const uint count = last - first;
    const uint groups = count / REFIT_TILE + (count % REFIT_TILE != 0);
    args.levels[level] = {first, count, 0, 0, rows_of_groups(groups), 0};
    first = last;
  }
}

}  // namespace coppice::twins
