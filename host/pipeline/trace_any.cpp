#include "pipeline/trace_any.h"

#include <stdexcept>

#include "pipeline/alpha_args.h"
#include "stages/stages.h"

namespace coppice {

AnyHitSlots plan_any_hits(Layout& layout, std::uint32_t ray_count) {
  AnyHitSlots slots;
  slots.rays = layout.add<Ray>("rays", ray_count);
  slots.any_hits = layout.add<uint>("any_hits", ray_count);
  slots.counters = layout.add<TraceCounters>("counters", 1);
  return slots;
}

void append_any_hits(Chain& chain, const TreeSlots& tree, const AnyHitSlots& slots, std::uint32_t ray_count,
                     const TraceOptions& options) {
  if (options.walk == Walk::brute_force) throw std::invalid_argument("any hits are looked for in a tree");
  if (is_wide(options.walk) && !can_trace_wide(options))
    throw std::invalid_argument("the wide tree is traced with the watertight and the robust test");
  check_fits(slots.rays, ray_count);
  check_fits(slots.any_hits, ray_count);
  const RayFilter& filter = slots.filter;
  const auto nodes = chain.at(tree.nodes);
  const auto triangles = chain.at(tree.triangles);
  const auto rays = chain.at(slots.rays);
  const auto any_hits = chain.at(slots.any_hits);
  const auto counters = chain.at(slots.counters);
  const auto state = chain.at(tree.state);
  const auto flags = address_or_null(chain, filter.primitive_flags);
  const auto masks = address_or_null(chain, filter.ray_masks);
  const auto count_at = address_or_null(chain, filter.count_at);
  if (is_wide(options.walk)) {
    const TraceWideAnyArgs args{chain.at(tree.wide_nodes),
                                chain.at(tree.wide_counts),
                                nodes,
                                triangles,
                                rays,
                                any_hits,
                                counters,
                                state,
                                flags,
                                masks,
                                count_at,
                                ray_count,
                                filter.ray_mask};
    const TraceWideConstants constants{options.max_turns, filter.masks(), 0};
    return run_trace(chain, stages::trace_wide_any, stages::trace_wide_any_alpha, filter.alpha, args,
                     counted_groups(ray_count, TRACE_BLOCK, count_at), constants);
  }
  const TraceAnyArgs args{nodes,
                          triangles,
                          rays,
                          any_hits,
                          counters,
                          state,
                          flags,
                          masks,
                          count_at,
                          ray_count,
                          filter.ray_mask,
                          options.stack_entries,
                          options.triangle_test,
                          options.box_test,
                          0};
  const TraceClosestConstants constants{options.max_turns,
                                        options.visits_per_turn,
                                        options.stack_entries,
                                        options.triangle_test,
                                        options.box_test,
                                        filter.masks(),
                                        0};
  run_trace(chain, stages::trace_any, stages::trace_any_alpha, filter.alpha, args,
            counted_groups(ray_count, TRACE_GROUP, count_at), constants);
}

CandidateSlots plan_candidates(Layout& layout, std::uint32_t ray_count, std::uint32_t capacity) {
  CandidateSlots slots;
  slots.capacity = capacity;
  slots.rays = layout.add<Ray>("rays", ray_count);
  slots.candidates = layout.add<BoxCandidate>("candidates", std::uint64_t{ray_count} * capacity);
  slots.candidate_counts = layout.add<uint>("candidate_counts", ray_count);
  slots.counters = layout.add<TraceCounters>("counters", 1);
  return slots;
}

void append_candidates(Chain& chain, const TreeSlots& tree, const CandidateSlots& slots,
                       std::uint32_t ray_count, const TraceOptions& options) {
  const std::uint64_t candidates = std::uint64_t{ray_count} * slots.capacity;
  if (candidates >> 32 != 0) throw std::invalid_argument("2^32 candidates or more");
  check_fits(slots.rays, ray_count);
  check_fits(slots.candidates, candidates);
  check_fits(slots.candidate_counts, ray_count);
  const RayFilter& filter = slots.filter;
  const auto count_at = address_or_null(chain, filter.count_at);
  chain.run(stages::trace_candidates,
            {chain.at(tree.nodes), chain.at(slots.rays), chain.at(slots.candidates),
             chain.at(slots.candidate_counts), chain.at(slots.counters), chain.at(tree.state),
             address_or_null(chain, filter.primitive_flags), address_or_null(chain, filter.ray_masks),
             count_at, ray_count, filter.ray_mask, options.stack_entries, slots.capacity},
            counted_groups(ray_count, TRACE_GROUP, count_at),
            {options.max_turns, options.stack_entries, filter.masks()});
}

}  // namespace coppice
