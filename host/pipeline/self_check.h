#pragma once

#include <functional>
#include <vector>

#include "gpu/device.h"
#include "pipeline/variants.h"
#include "stages/chain.h"

namespace coppice {

// Builds a small tree on the device, with these variants, and by the twins, before any result is shown.
// Returns whether lookback works there; if it does not, stages without it are to be used. Throws DeviceError
// for a device that computes neither right. `fault`, for tests, spoils the steps that the device is going to
// run.
bool check_lookback(Device& device, const Variants& variants,
                    const std::function<void(std::vector<Step>&)>& fault = {});

}  // namespace coppice
