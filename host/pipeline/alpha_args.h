#pragma once

#include "pipeline/alpha.h"
#include "stages/chain.h"

namespace coppice {

// The arguments of a trace as those of its stage with alpha.

inline TraceClosestAlphaArgs with_alpha(const Chain& chain, const TraceClosestArgs& a,
                                        const AlphaSlots& alpha) {
  return {a.nodes,
          a.triangles,
          a.rays,
          a.hits,
          a.counters,
          a.state,
          a.primitive_flags,
          a.ray_masks,
          a.count_at,
          a.ray_steps,
          chain.at(alpha.triangles),
          chain.at(alpha.maps),
          chain.at(alpha.texels),
          a.ray_count,
          a.ray_mask,
          a.stack_entries,
          a.triangle_test,
          a.box_test,
          0};
}

inline TraceWideAlphaArgs with_alpha(const Chain& chain, const TraceWideArgs& a, const AlphaSlots& alpha) {
  return {a.wide_nodes,
          a.wide_counts,
          a.nodes,
          a.triangles,
          a.rays,
          a.hits,
          a.counters,
          a.state,
          a.primitive_flags,
          a.ray_masks,
          a.count_at,
          a.ray_steps,
          chain.at(alpha.triangles),
          chain.at(alpha.maps),
          chain.at(alpha.texels),
          a.ray_count,
          a.ray_mask};
}

inline TraceAnyAlphaArgs with_alpha(const Chain& chain, const TraceAnyArgs& a, const AlphaSlots& alpha) {
  return {a.nodes,
          a.triangles,
          a.rays,
          a.any_hits,
          a.counters,
          a.state,
          a.primitive_flags,
          a.ray_masks,
          a.count_at,
          chain.at(alpha.triangles),
          chain.at(alpha.maps),
          chain.at(alpha.texels),
          a.ray_count,
          a.ray_mask,
          a.stack_entries,
          a.triangle_test,
          a.box_test,
          0};
}

inline TraceWideAnyAlphaArgs with_alpha(const Chain& chain, const TraceWideAnyArgs& a,
                                        const AlphaSlots& alpha) {
  return {a.wide_nodes,
          a.wide_counts,
          a.nodes,
          a.triangles,
          a.rays,
          a.any_hits,
          a.counters,
          a.state,
          a.primitive_flags,
          a.ray_masks,
          a.count_at,
          chain.at(alpha.triangles),
          chain.at(alpha.maps),
          chain.at(alpha.texels),
          a.ray_count,
          a.ray_mask};
}

// One of a trace's two stages: with alpha, where some triangles let rays through.
template <class Plain, class WithAlpha, class Args, class Constants, class Groups>
void run_trace(Chain& chain, const Plain& plain, const WithAlpha& other, const AlphaSlots& alpha,
               const Args& args, const Groups& groups, const Constants& constants) {
  if (alpha.any())
    chain.run(other, with_alpha(chain, args, alpha), groups, constants);
  else
    chain.run(plain, args, groups, constants);
}

}  // namespace coppice
