#pragma once

#include <string>

#include "measure/json.h"
#include "measure/measure_frame.h"
#include "scene/scene.h"

namespace coppice {

// What a frame took beside build and trace.
struct FrameSurroundings {
  std::string tracer;  // gpu or cpu
  std::string output;  // the file of the picture
  double load_ms = 0, prepare_ms = 0, write_ms = 0;
};

Json to_json(const FrameReport& report, const Scene& scene, const FrameRuns& frame,
             const FrameSurroundings& around);
std::string text_of(const FrameReport& report, const Scene& scene, const FrameRuns& frame,
                    const FrameSurroundings& around);

}  // namespace coppice
