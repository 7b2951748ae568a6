#pragma once

#include "apps/options.h"
#include "pipeline/checked_device.h"

namespace coppice {

// What the options say of a build; `morton_bits`: 30 or 60, see morton_bits_for.
BuildOptions build_options_of(const Options& options, std::uint32_t morton_bits);

// What they say of a trace.
TraceOptions trace_options_of(const Options& options);

// What a command is going to do on its device, and does not check by itself.
struct CommandUse {
  bool builds = true;
  bool traces = false;
  std::uint32_t triangle_count = 0;  // of the scene that it traces
};

// Notes go to stderr. Throws DeviceError if there is no such device or it fails.
CheckedDevice open_device(const Options& options, const CommandUse& command);

// Prints what the validation layers said, if anything; then the exit status is 1, else 0.
int validation_status(Device& device);

}  // namespace coppice
