#pragma once

#include "apps/options.h"
#include "gpu/device.h"
#include "pipeline/trace.h"

namespace coppice {

// A device that has passed the self-check, and what it asks of plans.
struct CheckedDevice {
  Device device;
  bool lookback;
  Variants variants;

  // `morton_bits`: 30 or 60, see morton_bits_for.
  BuildOptions build_options(const Options& options, std::uint32_t morton_bits) const;
  // Of the binary tree; of the wide one, whether it is walked in packets.
  TraceOptions trace_options(const Options& options) const;
  // Whether a picture of a scene of so many triangles is traced through the wide tree. Throws InputError
  // where the options ask for it and cannot have it.
  bool walks_wide(const Options& options, std::uint32_t triangle_count) const;

 private:
  bool packets(const Options& options) const;
};

// What a command is going to do on its device, and does not check by itself.
struct CommandUse {
  bool builds = true;
  bool traces = false;
  std::uint32_t triangle_count = 0;  // of the scene that it traces
};

// Throws DeviceError if there is no such device or it fails.
CheckedDevice open_device(const Options& options, const CommandUse& command);

// Prints what the validation layers said, if anything; then the exit status is 1, else 0.
int validation_status(Device& device);

}  // namespace coppice
