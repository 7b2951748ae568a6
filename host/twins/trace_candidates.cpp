#include <algorithm>
#include <limits>
#include <vector>

#include "interface/trace.h"
#include "twins/count_error.h"
#include "twins/intersect.h"
#include "twins/sight.h"
#include "twins/trace_counts.h"

namespace coppice::twins {

namespace {

// All leaves whose boxes the ray meets, in no order. Counts the pairs of nodes it visits.
std::vector<BoxCandidate> candidates_of(const TraceCandidatesArgs& args, const TraceRay& ray,
                                        const Ray& given, const Sight& sight, uint& pairs) {
  const float limit = ray.prepared({given.t_max, NO_TRIANGLE, 0, 0}).t;
  std::vector<BoxCandidate> candidates;
  for (std::vector<uint> stack = {0}; !stack.empty();) {
    const Node& node = args.nodes[stack.back()];
    stack.pop_back();
    float enter;
    if (!ray_meets_box(ray, node.box_min, node.box_max, BOX_ROBUST, limit, enter)) continue;
    if (node.height != 0) {
      ++pairs;
      stack.insert(stack.end(), {node.child, node.child + 1});
      continue;
    }
    const float t = ray.given_t(enter);
    if (t != std::numeric_limits<float>::infinity() && sight.sees(node.child))
      candidates.push_back({node.child, t < given.t_min ? given.t_min : t > given.t_max ? given.t_max : t});
  }
  return candidates;
}

bool is_before(const BoxCandidate& a, const BoxCandidate& b) {
  return a.t_enter != b.t_enter ? a.t_enter < b.t_enter : a.primitive < b.primitive;
}

}  // namespace

void trace_candidates(const TraceCandidatesArgs& args) {
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
    std::vector<BoxCandidate> candidates;
    if (!empty && ray.is_sound) {
      ray.approach(args.nodes[0].box_min, args.nodes[0].box_max);
      uint pairs = 0;
      candidates = candidates_of(args, ray, args.rays[i], Sight(args, i), pairs);
      std::ranges::sort(candidates, is_before);
      count_into(counters.steps, pairs);
    }
    const auto count = static_cast<uint>(candidates.size());
    for (uint k = 0; k < std::min(count, args.capacity); ++k)
      args.candidates[std::size_t{i} * args.capacity + k] = candidates[k];
    args.candidate_counts[i] = count;
    count_into(counters.rays, 1);
    count_into(counters.hits, count != 0);
  }
}

}  // namespace coppice::twins
