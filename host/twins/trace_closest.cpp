#include <utility>
#include <vector>

#include "interface/trace.h"
#include "twins/intersect.h"
#include "twins/trace_counts.h"

namespace coppice::twins {

namespace {

struct Visit {
  float enter;
  uint pair;
};

// Depth-first, nearer child first. Returns how many pairs of children it visited.
uint trace(const TraceClosestArgs& args, const Ray& ray, Hit& hit) {
  std::vector<Visit> stack;
  const auto meet = [&](const Node& child) {
    float enter;
    if (!ray_meets_box(ray, child.box_min, child.box_max, ray.t_min, hit.t * slab_pad, enter)) return false;
    if (child.height == 0) {
      ray_meets_triangle(ray, args.triangles[child.child], child.child, hit);
      return false;
    }
    stack.push_back({enter, child.child});
    return true;
  };

  uint steps = 0;
  meet(args.nodes[0]);
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (visit.enter > hit.t * slab_pad) continue;
    ++steps;
    const bool left = meet(args.nodes[visit.pair]);
    const bool right = meet(args.nodes[visit.pair + 1]);
    if (left && right) {
      Visit& first = stack[stack.size() - 2];
      Visit& second = stack.back();
      if (first.enter <= second.enter) std::swap(first, second);
    }
  }
  return steps;
}

}  // namespace

void trace_closest(const TraceClosestArgs& args) {
  TraceCounters& counters = args.counters[0];
  const bool empty = args.state[0].active_count == 0;
  if (!empty && args.nodes[0].height > args.stack_entries) {
    args.state[0].error_word |= ERROR_TREE_TOO_DEEP;
    return;
  }
  for (uint i = 0; i < args.ray_count; ++i) {
    if (!empty && ray_is_sound(args.rays[i]))
      count_into(counters.steps, trace(args, args.rays[i], args.hits[i]));
    count_into(counters.rays, 1);
    count_into(counters.hits, args.hits[i].triangle != NO_TRIANGLE);
  }
}

}  // namespace coppice::twins
