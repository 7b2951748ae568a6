#include "interface/trace.h"
#include "twins/intersect.h"
#include "twins/trace_counts.h"

namespace coppice::twins {

void trace_brute_force(const TraceBruteForceArgs& args) {
  TraceCounters& counters = args.counters[0];
  for (uint i = 0; i < args.ray_count; ++i) {
    count_into(counters.steps, args.triangle_count);
    const TraceRay ray(args.rays[i]);
    if (ray.is_sound) {
      Hit hit = ray.prepared(args.hits[i]);
      for (uint k = args.first_triangle; k < args.first_triangle + args.triangle_count; ++k) {
        ray_meets_triangle(ray, args.triangles[k], k, args.triangle_test, hit);
      }
      ray.keep(hit, args.hits[i]);
    }
    if (!args.last_slice) continue;
    count_into(counters.rays, 1);
    count_into(counters.hits, args.hits[i].triangle != NO_TRIANGLE);
  }
}

}  // namespace coppice::twins
