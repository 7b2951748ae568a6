#pragma once

#include <algorithm>
#include <bit>
#include <functional>
#include <vector>

#include "interface/trace.h"
#include "twins/count_error.h"
#include "twins/intersect.h"
#include "twins/sight.h"
#include "twins/trace_counts.h"
#include "twins/wide_distances.h"

namespace coppice::twins {

// A child of a wide node that a ray meets.
struct WideChildVisit {
  uint kept;  // bits of the distance
  uint word;  // of the child
};

// The children that the ray meets up to `limit`, the nearest last, as a stack has them.
inline std::vector<WideChildVisit> met_children(const WideNode& node, const WideDistances& distances,
                                                float limit) {
  struct Met {
    uint key;
    WideChildVisit visit;
  };
  std::vector<Met> met;
  for (uint child = 0; child < WIDE_CHILDREN; ++child) {
    float enter;
    if (node.child[child] == WIDE_EMPTY || !distances.meet(node, child, limit, enter)) continue;
    met.push_back({(std::bit_cast<uint>(enter) & ~(WIDE_CHILDREN - 1)) | child,
                   {WideDistances::kept_bits(enter), node.child[child]}});
  }
  std::ranges::sort(met, std::greater(), &Met::key);
  std::vector<WideChildVisit> visits;
  for (const Met& child : met) visits.push_back(child.visit);
  return visits;
}

// Depth-first, nearest child first. Returns how many nodes it visited.
template <class Args>
uint walk_wide_to_closest(const Args& args, const TraceRay& ray, const Sight& sight, Hit& hit) {
  const Node& root = args.nodes[0];
  const WideDistances distances(ray, root.box_min, root.box_max);
  uint visited = 0;
  for (std::vector<WideChildVisit> stack = {{0, 0}}; !stack.empty();) {
    const WideChildVisit visit = stack.back();
    stack.pop_back();
    const float limit = distances.of_hit(hit.t);
    if (visit.kept > WideDistances::kept_bits(limit)) continue;
    if (visit.word >= WIDE_LEAF) {
      const uint triangle = visit.word & ~WIDE_LEAF;
      if (sight.sees(triangle)) sight.meet(ray, args.triangles[triangle], triangle, TRIANGLE_WATERTIGHT, hit);
      continue;
    }
    ++visited;
    const std::vector<WideChildVisit> met = met_children(args.wide_nodes[visit.word], distances, limit);
    stack.insert(stack.end(), met.begin(), met.end());
  }
  return visited;
}

// Of the stage, and of its one with alpha.
template <class Args>
void trace_wide_single_of(const Args& args) {
  TraceCounters& counters = args.counters[0];
  const uint ray_count = counted(args.count_at, args.ray_count);
  note_ray_count(args.state[0], args.count_at, args.ray_count);
  for (uint i = 0; i < ray_count; ++i) {
    TraceRay ray(args.rays[i]);
    uint steps = 0;
    if (args.wide_counts[0].node_count != 0 && ray.is_sound) {
      const Node& root = args.nodes[0];
      ray.approach(root.box_min, root.box_max);
      Hit hit = ray.prepared(args.hits[i]);
      steps = walk_wide_to_closest(args, ray, Sight(args, i), hit);
      ray.keep(hit, args.hits[i]);
    }
    count_into(counters.steps, steps);
    keep_ray_steps(args, i, steps);
    count_into(counters.rays, 1);
    count_into(counters.hits, args.hits[i].triangle != NO_TRIANGLE);
  }
}

}  // namespace coppice::twins
