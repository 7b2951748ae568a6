#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interface/ploc.h"
#include "interface/trace.h"
#include "interface/wide.h"
#include "stages/chain.h"

namespace coppice {

// What a run left on the device that decides how many bytes its stages moved.
struct RunCounts {
  std::uint32_t active_count = 0;              // triangles in the tree
  std::uint32_t primitive_count = UINT32_MAX;  // where steps take their number from the device: that number
  std::vector<PlocRound> rounds;  // every entered round, the last with one cluster; empty: no build
  std::uint32_t wide_nodes = 0;
  std::vector<WideLevel> wide_levels;           // all of them; behind them none or empty ones
  std::uint64_t rays = 0, hits = 0, steps = 0;  // of the whole trace
};

// The counts behind the words of the device.
RunCounts counts_of_trace(const TraceCounters& counters);

// Bytes that a step moves by its stage's model, "cost" in docs/kernels.md: what must be read and written at
// least, once each. An indirect step without workgroups moves none. Empty for a stage without a model. A
// trace is described by its sums, so a step of it has its share by rays.
std::optional<std::uint64_t> modelled_bytes(const Step& step, const RunCounts& counts);

}  // namespace coppice
