#include "interface/wide.h"

namespace coppice::twins {

void wide_sizes(const WideSizesArgs& args) {
  const WideLevel& level = args.levels[args.level];
  for (uint index = level.first; index < level.first + level.count; ++index) {
    const WideEntry& entry = args.entries[index];
    args.sizes[index] = 1;
    for (uint child = entry.first_child; child < entry.first_child + entry.child_count; ++child) {
      args.offsets[child] = args.sizes[index];
      args.sizes[index] += args.sizes[child];
    }
  }
}

}  // namespace coppice::twins
