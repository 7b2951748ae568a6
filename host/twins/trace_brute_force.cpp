#include "interface/trace.h"
#include "twins/intersect.h"
#include "twins/trace_counts.h"

namespace coppice::twins {

void trace_brute_force(const TraceBruteForceArgs& args) {
  TraceCounters& counters = args.counters[0];
  for (uint i = 0; i < args.ray_count; ++i) {
    count_into(counters.steps, args.triangle_count);
    if (ray_is_sound(args.rays[i])) {
      for (uint k = args.first_triangle; k < args.first_triangle + args.triangle_count; ++k) {
        ray_meets_triangle(args.rays[i], args.triangles[k], k, args.hits[i]);
      }
    }
    if (!args.last_slice) continue;
    count_into(counters.rays, 1);
    count_into(counters.hits, args.hits[i].triangle != NO_TRIANGLE);
  }
}

}  // namespace coppice::twins
