#pragma once

#include "pipeline/self_check.h"

namespace coppice {

// check_device, once for each device, driver and set of kernels: the verdict is kept in a file beside the
// compiled pipelines, a line for each use. Where nothing is kept, or what is kept does not fit, it is checked
// anew. Refusals are never kept.
bool kept_check_device(Device& device, const DeviceUse& use);

// All that decides what a check does, in one line.
std::string line_of(const DeviceUse& use);

}  // namespace coppice
