#pragma once

#include "gpu/device.h"

namespace coppice {

// Builds a small tree on the device and by the twins, before any result is shown. Returns whether lookback
// works there; if it does not, stages without it are to be used. Throws DeviceError for a device that
// computes neither right.
bool check_lookback(Device& device);

}  // namespace coppice
