#pragma once

#include "measure/animate.h"
#include "render/film.h"

namespace coppice {

// The film of any time, by the camera that moves where the scene still has one (stand_up); it is made once
// where the camera stands still. The scene must outlive it.
class Films {
 public:
  Films(const Scene& scene, const AnimateRuns& runs)
      : motion_(runs.camera.empty() && scene.camera ? scene.motion.get() : nullptr),
        lens_(scene.lens),
        trace_(runs.trace),
        still_(make_film(scene, runs.camera, trace_.width, trace_.height, trace_.samples)) {}

  Film at(double seconds) const {
    if (!motion_) return still_;
    const std::optional<Camera> camera = pose_at(*motion_, seconds).camera;
    return camera ? make_film(*camera, lens_, trace_.width, trace_.height, trace_.samples) : still_;
  }

 private:
  const Motion* motion_;
  Lens lens_;
  TraceOptions trace_;
  Film still_;
};

}  // namespace coppice
