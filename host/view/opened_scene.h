#pragma once

#include "measure/builder_choice.h"
#include "pipeline/walk.h"
#include "render/scene_arrays.h"
#include "scene/scene_source.h"

namespace coppice {

// A scene that has been opened, and its tree where the host builds that.
struct OpenedScene {
  SceneOptions options{};
  Scene scene;
  SceneArrays arrays;
  Aabb box;
  BuilderChoice builder{};  // with one of the host:
  Bvh bvh{};
  double build_ms = 0;         // that it took
  bool has_instances = false;  // before they were flattened, where options do not keep them
};

// Whether instances are seen as such, through two levels: by builders of the device, and where the choice is
// no wide tree. Else they are flattened.
bool keeps_instances(const BuilderChoice& builder, const WalkChoice& walk);

// Reads and makes all of it; with a builder of the device no tree. Throws as open_scene does.
OpenedScene open_for_view(const SceneOptions& options, const BuilderChoice& builder);

}  // namespace coppice
