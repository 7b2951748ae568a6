#include "interface/wide.h"

namespace coppice::twins {

void wide_sizes(const WideSizesArgs& args) {
  // Children come behind their parents, so from the last one on every size is complete when it is reached.
  for (uint index = args.counts[0].node_count; index-- > 0;) {
    const WideEntry& entry = args.entries[index];
    uint size = 1;
    for (uint child = entry.first_child; child < entry.first_child + entry.child_count; ++child) {
      args.offsets[child] = size;
      size += args.sizes[child] & ((1u << WIDE_ARRIVAL_SHIFT) - 1);
    }
    args.sizes[index] = entry.child_count << WIDE_ARRIVAL_SHIFT | size;
  }
}

}  // namespace coppice::twins
