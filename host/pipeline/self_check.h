#pragma once

#include <functional>
#include <vector>

#include "gpu/device.h"
#include "pipeline/trace_plan.h"
#include "stages/chain.h"

namespace coppice {

// What a command is going to do on a device.
struct DeviceUse {
  bool builds = true;                // else the trees that it traces are the host's
  BuildOptions build{};              // but for `lookback`, which the check decides
  std::vector<TraceOptions> traces;  // every tracer that it runs; the check has rays of its own
  std::uint32_t triangle_count = 0;  // of the scene that it traces, by which a walk may be chosen
};

// Runs it for a small scene on the device and by the twins, before any result is shown: the tree must be the
// same bit for bit, and so must the hits, which on a GPU may differ within their tolerance (stages/nearly.h).
// Returns whether lookback works there; if it does not, stages without it are to be used. Throws DeviceError
// for a device that computes neither right. `fault`, for tests, spoils the steps that the device is going to
// run.
bool check_device(Device& device, const DeviceUse& use,
                  const std::function<void(std::vector<Step>&)>& fault = {});

}  // namespace coppice
