#pragma once

#include <cmath>
#include <vector>

#include "interface/trace.h"
#include "twins/count_error.h"
#include "twins/intersect.h"
#include "twins/sight.h"
#include "twins/trace_counts.h"
#include "twins/wide_distances.h"

namespace coppice::twins {

template <class Args>
bool hits_triangle(const Args& args, const TraceRay& ray, const Sight& sight, uint triangle, float t_max) {
  Hit hit{t_max, NO_TRIANGLE, 0, 0};
  sight.meet(ray, args.triangles[triangle], triangle, TRIANGLE_WATERTIGHT, hit);
  return hit.triangle != NO_TRIANGLE && !std::isinf(ray.given_t(hit.t));
}

// Depth-first, children in the order of their slots, up to the first hit. Counts the nodes it visits.
template <class Args>
bool hits_any(const Args& args, const TraceRay& ray, const Sight& sight, float t_max, uint& visited) {
  const Node& root = args.nodes[0];
  const WideDistances distances(ray, root.box_min, root.box_max);
  const float limit = distances.of_hit(t_max);
  for (std::vector<uint> stack = {0}; !stack.empty();) {
    const uint word = stack.back();
    stack.pop_back();
    if (word < WIDE_LEAF) {
      ++visited;
      const WideNode& node = args.wide_nodes[word];
      for (uint child = WIDE_CHILDREN; child-- > 0;) {
        float enter;
        if (node.child[child] != WIDE_EMPTY && distances.meet(node, child, limit, enter))
          stack.push_back(node.child[child]);
      }
      continue;
    }
    const uint triangle = word & ~WIDE_LEAF;
    if (sight.sees_opaque(triangle) && hits_triangle(args, ray, sight, triangle, t_max)) return true;
  }
  return false;
}

// Of the stage, and of its one with alpha.
template <class Args>
void trace_wide_any_of(const Args& args) {
  TraceCounters& counters = args.counters[0];
  const uint ray_count = counted(args.count_at, args.ray_count);
  note_ray_count(args.state[0], args.count_at, args.ray_count);
  for (uint i = 0; i < ray_count; ++i) {
    TraceRay ray(args.rays[i]);
    bool hits = false;
    if (args.wide_counts[0].node_count != 0 && ray.is_sound) {
      const Node& root = args.nodes[0];
      ray.approach(root.box_min, root.box_max);
      uint visited = 0;
      hits = hits_any(args, ray, Sight(args, i), ray.prepared({args.rays[i].t_max, NO_TRIANGLE, 0, 0}).t,
                      visited);
      count_into(counters.steps, visited);
    }
    args.any_hits[i] = hits;
    count_into(counters.rays, 1);
    count_into(counters.hits, hits);
  }
}

}  // namespace coppice::twins
