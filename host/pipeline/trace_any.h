#pragma once

#include "pipeline/trace_plan.h"

namespace coppice {

// Rays, and whether each hits anything.
struct AnyHitSlots {
  Slot<Ray> rays;
  Slot<uint> any_hits;  // out, one a ray: 1 or 0
  Slot<TraceCounters> counters;
  RayFilter filter{};
};

// Without a filter. Throws LayoutError if a slot does not fit a block.
AnyHitSlots plan_any_hits(Layout& layout, std::uint32_t ray_count);

// Whether each of the first `ray_count` rays hits something, see TraceAnyArgs. Of the options those matter
// that matter to closest hits; through the wide tree each ray goes by itself. Throws LayoutError where the
// slots do not have so many rays, std::invalid_argument for brute force and for a wide tree with other tests
// than watertight and robust.
void append_any_hits(Chain& chain, const TreeSlots& tree, const AnyHitSlots& slots, std::uint32_t ray_count,
                     const TraceOptions& options);

// Rays, and the leaves whose boxes each meets, see TraceCandidatesArgs.
struct CandidateSlots {
  std::uint32_t capacity = 0;  // candidates of a ray that are kept
  Slot<Ray> rays;
  Slot<BoxCandidate> candidates;  // out: `capacity` a ray
  Slot<uint> candidate_counts;    // out: one a ray, of all that it meets
  Slot<TraceCounters> counters;
  RayFilter filter{};
};

// Without a filter. Throws LayoutError if a slot does not fit a block.
CandidateSlots plan_candidates(Layout& layout, std::uint32_t ray_count, std::uint32_t capacity);

// The candidates of the first `ray_count` rays in the binary tree, whatever the options say of a wide one;
// its triangles are not looked at. Throws LayoutError where the slots do not have so many rays or candidates,
// std::invalid_argument for 2^32 candidates or more.
void append_candidates(Chain& chain, const TreeSlots& tree, const CandidateSlots& slots,
                       std::uint32_t ray_count, const TraceOptions& options);

}  // namespace coppice
