#include "interface/trace.h"
#include "twins/device_count.h"

namespace coppice::twins {

void trace_misses(const TraceMissesArgs& args) {
  for (uint i = 0; i < counted(args.count_at, args.ray_count); ++i)
    args.hits[i] = {args.rays[i].t_max, NO_TRIANGLE, 0, 0};
}

}  // namespace coppice::twins
