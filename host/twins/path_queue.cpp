#include "interface/paths.h"

namespace coppice::twins {

void path_queue(const PathQueueArgs& args) {
  uint count = 0;
  for (uint i = 0; i < args.ray_count; ++i) {
    if (args.marks[i] == 0) continue;
    args.queued_rays[count] = args.marked_rays[i];
    if (args.marked_paths.value != 0) {
      args.queued_paths[count] = args.marked_paths[i];
      args.queued_hits[count] = {args.marked_rays[i].t_max, NO_TRIANGLE, 0, 0};
    }
    ++count;
  }
  args.queued_count[0] = count;
}

}  // namespace coppice::twins
