#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "interface/trace.h"
#include "twins/count_error.h"
#include "twins/intersect.h"
#include "twins/sight.h"
#include "twins/trace_counts.h"

namespace coppice::twins {

// The walk of trace_closest, up to the first hit.
template <class Args>
class AnyWalk {
 public:
  AnyWalk(const Args& args, const TraceRay& ray, const Sight& sight, float t_max)
      : args_(args), ray_(ray), sight_(sight), t_max_(t_max) {}

  bool hits() {
    float enter;
    if (meet(args_.nodes[0], enter)) stack_.push_back(args_.nodes[0].child);
    while (!found_ && !stack_.empty()) {
      const uint pair = stack_.back();
      stack_.pop_back();
      ++steps;
      const Node &left = args_.nodes[pair], &right = args_.nodes[pair + 1];
      float left_enter, right_enter;
      const bool go_left = meet(left, left_enter), go_right = meet(right, right_enter);
      const bool left_first = go_left && (!go_right || left_enter <= right_enter);
      if (left_first && go_right) stack_.push_back(right.child);
      if (go_left) stack_.push_back(left.child);
      if (go_right && !left_first) stack_.push_back(right.child);
    }
    return found_;
  }

  uint steps = 0;

 private:
  // Whether to go on into the node.
  bool meet(const Node& node, float& enter) {
    if (!ray_meets_box(ray_, node.box_min, node.box_max, args_.box_test, t_max_, enter)) return false;
    if (node.height != 0) return true;
    if (!sight_.sees_opaque(node.child)) return false;
    Hit hit{t_max_, NO_TRIANGLE, 0, 0};
    sight_.meet(ray_, args_.triangles[node.child], node.child, args_.triangle_test, hit);
    if (hit.triangle != NO_TRIANGLE && !std::isinf(ray_.given_t(hit.t))) found_ = true;
    return false;
  }

  const Args& args_;
  const TraceRay& ray_;
  const Sight& sight_;
  const float t_max_;
  bool found_ = false;
  std::vector<uint> stack_;
};

// Of the stage, and of its one with alpha.
template <class Args>
void trace_any_of(const Args& args) {
  TraceCounters& counters = args.counters[0];
  bool empty = args.state[0].active_count == 0;
  if (!empty && args.nodes[0].height > args.stack_entries) {
    args.state[0].error_word |= ERROR_TREE_TOO_DEEP;
    empty = true;
  }
  const uint ray_count = counted(args.count_at, args.ray_count);
  note_ray_count(args.state[0], args.count_at, args.ray_count);
  for (uint i = 0; i < ray_count; ++i) {
    TraceRay ray(args.rays[i]);
    bool hits = false;
    if (!empty && ray.is_sound) {
      const Node& root = args.nodes[0];
      ray.approach(root.box_min, root.box_max);
      const Sight sight(args, i);
      AnyWalk walk(args, ray, sight, ray.prepared({args.rays[i].t_max, NO_TRIANGLE, 0, 0}).t);
      hits = walk.hits();
      count_into(counters.steps, walk.steps);
    }
    args.any_hits[i] = hits;
    count_into(counters.rays, 1);
    count_into(counters.hits, hits);
  }
}

}  // namespace coppice::twins
