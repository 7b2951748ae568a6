#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/trace_any.h"
#include "support/test_device.h"

namespace coppice {

// A tree, rays and what they see. Empty: no such words.
struct RaysToTrace {
  std::span<const Node> nodes;
  std::span<const Triangle> triangles;
  std::span<const Ray> rays;
  std::vector<uint> primitive_flags{}, ray_masks{};
  uint ray_mask = PRIMITIVE_MASK;
  std::optional<uint> count{};  // the word on the device
};

// What slots hold that nothing was written to.
inline constexpr uint UNTOUCHED = 0xabcd;

struct TracedBoth {
  std::vector<Hit> hits;       // closest ones; UNTOUCHED in `triangle`
  std::vector<uint> any_hits;  // or UNTOUCHED
  TraceCounters hit_counters{}, any_counters{};
  uint error_word = 0;
};

// Closest hits and any hits by every kernel and its twin, through the tree or, as the options say, the wide
// tree made from it. Fails where they differ in any word of memory.
TracedBoth trace_in_lockstep(const RaysToTrace& input, const TraceOptions& options,
                             Device& device = test_device());

// The same without the steps, which the tracers of wide trees count in distances that a device may fuse, and
// so not alike in every scene; and without lockstep.
TracedBoth trace_on_both(const RaysToTrace& input, const TraceOptions& options);

struct TracedCandidates {
  std::vector<BoxCandidate> candidates;  // `capacity` a ray; UNTOUCHED in `primitive`
  std::vector<uint> counts;              // one a ray, or UNTOUCHED
  TraceCounters counters{};
  uint error_word = 0;
};

// Candidates in the same way; the triangles do not matter.
TracedCandidates candidates_in_lockstep(const RaysToTrace& input, std::uint32_t capacity,
                                        const TraceOptions& options, Device& device = test_device());

inline bool has_hit(const Hit& hit) { return hit.triangle != NO_TRIANGLE; }

}  // namespace coppice
