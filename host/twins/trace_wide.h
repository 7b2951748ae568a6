#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "interface/trace.h"
#include "twins/count_error.h"
#include "twins/trace_counts.h"
#include "twins/wide_packet.h"

namespace coppice::twins {

// The rays from `first` on. Returns how many nodes they visit.
template <class Args>
uint trace_packet(const Args& args, uint first, uint count) {
  WidePacket packet(args.wide_nodes, args.triangles);
  std::vector<uint> indices;
  for (uint i = first; i < first + count; ++i) {
    TraceRay ray(args.rays[i]);
    if (!ray.is_sound) continue;
    const Node& root = args.nodes[0];
    ray.approach(root.box_min, root.box_max);
    packet.add(ray, Sight(args, i), ray.prepared(args.hits[i]));
    indices.push_back(i);
  }
  const uint visited = packet.trace();
  for (std::size_t k = 0; k < indices.size(); ++k)
    packet.rays()[k].keep(packet.hits()[k], args.hits[indices[k]]);
  return visited;
}

// Of the stage, and of its one with alpha.
template <class Args>
void trace_wide_of(const Args& args) {
  TraceCounters& counters = args.counters[0];
  const uint ray_count = counted(args.count_at, args.ray_count);
  note_ray_count(args.state[0], args.count_at, args.ray_count);
  for (uint first = 0; first < ray_count; first += TRACE_PACKET) {
    const uint count = std::min(TRACE_PACKET, ray_count - first);
    const uint steps = args.wide_counts[0].node_count != 0 ? trace_packet(args, first, count) : 0;
    count_into(counters.steps, std::uint64_t{steps} * count);
    count_into(counters.rays, count);
    for (uint i = first; i < first + count; ++i) {
      count_into(counters.hits, args.hits[i].triangle != NO_TRIANGLE);
      keep_ray_steps(args, i, steps);
    }
  }
}

}  // namespace coppice::twins
