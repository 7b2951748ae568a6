#pragma once

#include <utility>
#include <vector>

#include "interface/trace.h"
#include "twins/count_error.h"
#include "twins/intersect.h"
#include "twins/sight.h"
#include "twins/trace_counts.h"

namespace coppice::twins {

struct PairVisit {
  float enter;
  uint pair;
};

// Depth-first, nearer child first. Returns how many pairs of children it visited.
template <class Args>
uint walk_to_closest(const Args& args, const TraceRay& ray, const Sight& sight, Hit& hit) {
  std::vector<PairVisit> stack;
  const auto meet = [&](const Node& child) {
    float enter;
    if (!ray_meets_box(ray, child.box_min, child.box_max, args.box_test, hit.t, enter)) return false;
    if (child.height == 0) {
      if (sight.sees(child.child))
        sight.meet(ray, args.triangles[child.child], child.child, args.triangle_test, hit);
      return false;
    }
    stack.push_back({enter, child.child});
    return true;
  };

  uint steps = 0;
  meet(args.nodes[0]);
  while (!stack.empty()) {
    const PairVisit visit = stack.back();
    stack.pop_back();
    if (visit.enter > hit.t) continue;
    ++steps;
    const bool left = meet(args.nodes[visit.pair]);
    const bool right = meet(args.nodes[visit.pair + 1]);
    if (left && right) {
      PairVisit& first = stack[stack.size() - 2];
      PairVisit& second = stack.back();
      if (first.enter <= second.enter) std::swap(first, second);
    }
  }
  return steps;
}

// Of the stage, and of its one with alpha.
template <class Args>
void trace_closest_of(const Args& args) {
  TraceCounters& counters = args.counters[0];
  const bool empty = args.state[0].active_count == 0;
  note_ray_count(args.state[0], args.count_at, args.ray_count);
  if (!empty && args.nodes[0].height > args.stack_entries) {
    args.state[0].error_word |= ERROR_TREE_TOO_DEEP;
    return;
  }
  const uint ray_count = counted(args.count_at, args.ray_count);
  for (uint i = 0; i < ray_count; ++i) {
    TraceRay ray(args.rays[i]);
    uint steps = 0;
    if (!empty && ray.is_sound) {
      const Node& root = args.nodes[0];
      ray.approach(root.box_min, root.box_max);
      Hit hit = ray.prepared(args.hits[i]);
      steps = walk_to_closest(args, ray, Sight(args, i), hit);
      ray.keep(hit, args.hits[i]);
    }
    count_into(counters.steps, steps);
    keep_ray_steps(args, i, steps);
    count_into(counters.rays, 1);
    count_into(counters.hits, args.hits[i].triangle != NO_TRIANGLE);
  }
}

}  // namespace coppice::twins
