#include "interface/refit.h"
#include "twins/wide_levels.h"

namespace coppice::twins {

void refit_levels(const RefitLevelsArgs& args) {
  uint first = 0;
  for (uint level = 0; level <= REFIT_MAX_HEIGHT; ++level) {
    uint of_kind[4] = {};
    uint last = first;
    for (; last < args.pair_count[0] && args.keys[last] / 4 == level; ++last) ++of_kind[args.keys[last] % 4];
    const uint count = last - first;
    const uint left_end = of_kind[REFIT_TWO_LEAVES] + of_kind[REFIT_LEFT_LEAF];
    const uint right_end = left_end + of_kind[REFIT_RIGHT_LEAF];
    const uint groups = count / REFIT_TILE + (count % REFIT_TILE != 0);
    args.levels[level] = {first, count, left_end, right_end, rows_of_groups(groups), 0};
    first = last;
  }
}

}  // namespace coppice::twins
