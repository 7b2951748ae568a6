#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/builder_choice.h"
#include "measure/json.h"
#include "measure/refine.h"
#include "pipeline/checked_device.h"
#include "pipeline/trace_plan.h"
#include "render/show.h"
#include "render/update_chooser.h"
#include "scene/scene_source.h"

namespace coppice {

// What a window begins with.
struct ViewRun {
  SceneOptions scene{};
  BuilderChoice builder{};
  DeviceOptions device{};
  DeviceChoices choices{};
  TraceOptions trace{};          // its size is the window's
  std::vector<double> camera{};  // see given_view; empty: the scene's
  ShowOptions show{};
  RefineLimits refine{.most_samples = 64};  // of pictures of colours that stand still
  bool paused = false;                      // a moving scene stands still at first
  bool rebuild = false;                     // the tree is made anew for every frame
  Update update = Update::rebuild;
  bool panes = true;         // they are shown
  std::uint32_t frames = 0;  // ends after so many, one step of the scene each; 0: when it is closed
  std::string pictures = "coppice-view";  // what the names of pictures begin with
  bool talks = true;                      // what happens goes to stdout, a line each
};

struct ViewReport {
  std::string scene, builder, device, driver, walk;
  std::uint64_t triangles = 0;
  std::uint32_t width = 0, height = 0;      // of the last picture
  std::uint64_t frames = 0;                 // pictures that were made
  std::vector<double> frame_ms, device_ms;  // of the last of them
  std::uint64_t image_hash = 0;
  std::vector<std::string> validation_messages;
};
Json to_json(const ViewReport& report);

// Opens the window, and returns when it is closed, even where a scene is still being opened: by a loose
// thread, see pipeline/loose_thread.h. A device that is lost is made anew, unless it is lost again before it
// has shown a picture. Throws InputError for a scene at the beginning that cannot be opened, DeviceError
// where there is no display, no device that presents, or it fails, and Interrupted.
ViewReport run_view(const ViewRun& run, const Note& note);

}  // namespace coppice
