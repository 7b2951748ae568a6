#pragma once

#include "apps/measure_build.h"

namespace coppice {

struct RenderReport {
  BuildReport build;
  double wide_ms = 0;  // of the conversion to wide nodes; 0 where the binary tree is walked
  double trace_ms = 0;
  std::uint64_t rays = 0, hits = 0, steps = 0;
  std::string trace_device;  // name and driver
  bool walks_wide = false;
  KernelTable kernels;      // of the trace, on a device
  std::vector<uint> image;  // RGBA8
};

// Builds in one submit and traces in as many as keep each short, with nothing but times read back in between;
// with a CPU builder its tree is uploaded before. With `split` the frame is run once more for the times of
// the kernels, and for the file of trace events. Throws Interrupted on SIGINT or SIGTERM between two submits.
RenderReport render_on_device(CheckedDevice& device, const Scene& scene, const Options& options,
                              TraceOptions trace_options, bool split);

// Traces by the independent CPU tracer; shades by the twins. With a builder on the device `device` builds the
// tree. Throws Interrupted as well.
RenderReport render_on_host(CheckedDevice* device, const Scene& scene, const Options& options);

}  // namespace coppice
