#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/build_report.h"
#include "measure/builder_choice.h"
#include "measure/refine.h"
#include "pipeline/checked_device.h"
#include "pipeline/trace_plan.h"
#include "render/scene_arrays.h"
#include "render/show.h"
#include "scene/effect_set.h"

namespace coppice {

// How a frame is measured.
struct FrameRuns {
  BuilderChoice builder{};
  TraceOptions trace{};          // of a trace on a device: what the device asks of it, too
  std::vector<double> camera{};  // see given_view; empty: the scene's
  std::uint32_t runs = 1;        // the whole frame so many times
  bool split = false;            // once more, for the times of kernels and the file of trace events
  std::string trace_events{};    // a file; empty: none
  ShowOptions show{};            // clusters only of gpu-ploc
  EffectChanges effects{};       // beside what the scene calls for
  RefineLimits refine{};         // if there are any, one run; samples are those of the trace at most
  bool explains = false;         // the report says why each effect is on or off
};

// What a picture shows in place of colours, and between which values.
struct ShownReport {
  ShowOptions options{};
  ShowSpan scale{}, seen{};
  std::uint64_t clusters = 0;
};

struct FrameReport {
  BuildReport build;
  double wide_ms = 0;  // of the conversion to wide nodes; 0 where the binary tree is walked
  double trace_ms = 0;
  std::uint64_t rays = 0, hits = 0, steps = 0;  // of the camera's rays
  TraceCounts shadow;                           // of shadow rays
  TraceCounts occlusion;                        // of occlusion rays
  TraceCounts bounced;                          // of paths behind those of the camera
  LobeCounts lobes;                             // the same by the lobe of the surface
  std::string trace_device;                     // name and driver
  bool walks_wide = false;
  KernelTable kernels;         // of the trace, on a device; of a refined one of one more sample
  std::vector<uint> image;     // RGBA8
  std::vector<vec3> radiance;  // linear, a mean a pixel, rows top to bottom; if it was asked for
  ShownReport shown;
  std::optional<Refined> refined{};
};

// Builds in one submit and traces in as many as keep each short, with nothing but times read back in between;
// with a CPU builder its tree is uploaded before. Throws Interrupted on SIGINT or SIGTERM between two
// submits. `arrays` are the scene's, with the effects that the frame says.
FrameReport measure_frame(CheckedDevice& device, const Scene& scene, const SceneArrays& arrays,
                          const FrameRuns& frame);

// Traces by the independent CPU tracer; shades by the twins. With a builder on the device `device` builds the
// tree. Throws Interrupted as well.
FrameReport measure_host_frame(CheckedDevice* device, const Scene& scene, const SceneArrays& arrays,
                               const FrameRuns& frame, const Note& note);

}  // namespace coppice
