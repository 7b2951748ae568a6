#pragma once

#include <functional>
#include <vector>

#include "gpu/device.h"
#include "pipeline/trace_plan.h"
#include "stages/chain.h"

namespace coppice {

// What a command, or an object of the library, is going to do on a device.
struct DeviceUse {
  bool builds = true;                  // else the trees that it traces are the host's
  BuildOptions build{};                // but for `lookback`, which the check decides; of the rest here, too
  std::vector<TraceOptions> traces{};  // every tracer that it runs; the check has rays of its own
  std::uint32_t triangle_count = 0;    // of the scene that it traces, by which a walk may be chosen
  bool wide = false;                   // the tree that is built is converted, too, whoever walks it
  bool refits = false;                 // of trees over triangles that move
  bool inputs = false;                 // vertices, indices, transforms and boxes
  bool vertices = false;               // that move
  bool instances = false;              // in two levels
  bool batches = false;                // of small trees
  bool sorts = false;                  // in place, see sorted_in_place()
  bool sorts_values = false;           // beside the keys
  bool scans = false;
  bool every_ray = false;  // beside closest hits any hits and candidates, and all with flags and masks, too
};

// Spoils the steps that a device is going to run: for tests.
using CheckFault = std::function<void(std::vector<Step>&)>;

// Runs it for a small scene on the device and by the twins, before any result is shown: all that is built
// must be the same bit for bit, and so must the hits, which on a GPU may differ within their tolerance
// (stages/nearly.h). Returns whether lookback works there; if it does not, stages without it are to be used.
// Throws DeviceError for a device that computes wrong either way.
bool check_device(Device& device, const DeviceUse& use, const CheckFault& fault = {});

}  // namespace coppice
