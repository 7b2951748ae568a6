#pragma once

#include "gpu/device.h"

namespace coppice {

// One line on stderr where a software driver is much slower than a newer one of its kind, with the remedy.
void note_slow_driver(const DeviceProperties& device);

}  // namespace coppice
