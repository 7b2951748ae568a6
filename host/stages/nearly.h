#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "gpu/device.h"
#include "stages/stage.h"

namespace coppice {

// What a GPU left in a slot, beside what the twin left there, from the same input. Within the tolerance are
//   rays      vectors that differ by at most 2^-18 of their largest component
//   hits      the same triangle, t within 2^-16 of itself, u and v within 1/16 (a small triangle far away is
//   a
//             few roundings wide); 1 of 1,000 may be anything else, as a ray that meets an edge may go either
//             way; and of two triangles at the same t 1 of 100 may be the other one
//   any_hits  0 or 1 (marks, too); 1 of 1,000 may be the other one
//   hit_instances  1 of 100 may be another one
//   candidates  the same primitive, t_enter within 2^-16 of itself; 1 of 100 may be anything else, as
//             neighbours may change places, and all that follow move up where one is missing
//   candidate_counts  1 of 1,000 may be another one
//   counters  as many rays, hits within 1 in 1,000 rays, steps within 1 in 100 and 64
//   radiance  colours that differ by at most 2^-16 of the largest channel, or of 1; 1 of 1,000 may be
//   anything
//             else, as a surface seen edge-on may be lit from either side
//   noise     sums of squared errors within 2^-12 of themselves
//   image     no channel off by more than one code, and 1 pixel of 1,000 by that
// Of fewer than a tenth of the 1,000, or 100, none may differ.
struct NearlyEqual {
  std::uint64_t count = 0;                       // compared
  std::uint64_t differing = 0;                   // in any bit
  std::uint64_t beyond = 0, beyond_allowed = 0;  // the tolerance
  std::uint64_t tied = 0, tied_allowed = 0;      // of hits: another triangle at the same t
  double largest_relative_t = 0;                 // of hits on the same triangle or tied
  std::optional<std::uint64_t> first;  // beyond the tolerance, or tied where only these are too many

  bool holds() const { return beyond <= beyond_allowed && tied <= tied_allowed; }
};

// Whether a device divides and takes square roots as the host does, so that every bit can be compared.
bool rounds_like_the_host(const DeviceProperties& properties);

// Of whole slots. Throws std::logic_error where the bytes are no such elements.
NearlyEqual compare_nearly(Nearly like, std::span<const std::byte> cpu, std::span<const std::byte> gpu);

}  // namespace coppice
