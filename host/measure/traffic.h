#pragma once

#include <cstdint>

#include "interface/trace.h"
#include "pipeline/trace_plan.h"
#include "stages/chain.h"
#include "stages/gpu_executor.h"
#include "stages/run_counts.h"

namespace coppice {

// The counts behind the words of the device.
RunCounts counts_of_trace(const TraceCounters& counters);

// The same of a picture's rays, shadow and occlusion rays among them.
RunCounts counts_of_picture(const GpuExecutor& executor, const TracePlan& plan);

// Bytes that a step moves by its stage's model, "cost" in docs/kernels.md: what must be read and written at
// least, once each. An indirect step without workgroups moves none. A trace is described by its sums, so a
// step of it has its share by rays.
std::uint64_t modelled_bytes(const Step& step, const RunCounts& counts);

}  // namespace coppice
