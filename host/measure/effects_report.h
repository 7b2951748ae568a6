#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/json.h"
#include "measure/measure_frame.h"
#include "render/frame.h"
#include "scene/effect_set.h"

namespace coppice {

// What a frame records for its picture: a pure function of scene and options, nothing runs.
struct RecordedPicture {
  struct Kernel {
    std::string name;
    std::uint32_t dispatches = 0;
  };
  std::vector<Kernel> kernels;                    // in order of appearance
  std::vector<std::string> slots;                 // names
  std::uint64_t device_bytes = 0;                 // of all slots
  std::uint32_t effect_steps[effect_count] = {};  // that belong to that effect alone
};
RecordedPicture recorded_picture(const SceneArrays& arrays, const FrameOptions& options);

// What an effect costs in a picture: the picture with it, less the picture without it.
struct EffectCost {
  Effect effect{};
  EffectSet::State state{};
  std::vector<RecordedPicture::Kernel> kernels{};     // that it adds
  std::vector<RecordedPicture::Kernel> instead_of{};  // that it does without
  std::uint32_t own_steps = 0;                        // recorded for it alone; 0 where it is off
  std::uint64_t rays = 0;
  std::int64_t bytes = 0;
  // Of the kernels that differ, or of all where none does; empty on a device without timestamps.
  std::optional<double> ms = 0;

  // Whether each of its steps is one that another effect, which is on, takes as well, as kinds of paths do.
  bool shares_kernels() const {
    return state.on && kernels.empty() && own_steps > 0 && effect != Effect::depth_of_field;
  }
  std::uint32_t dispatches() const;  // that it adds, or shares; those recorded for it where it is off
};

struct EffectsReport {
  std::string scene, device;
  double trace_ms = 0;  // with all effects that are on
  std::uint64_t camera_rays = 0;
  std::vector<EffectCost> costs;  // of every effect
};

// Makes the picture with all that is on, and once more without each. Arrays and what it throws are those of
// measure_frame.
EffectsReport measure_effects(CheckedDevice& device, const Scene& scene, const SceneArrays& arrays,
                              const FrameRuns& frame);

// A line an effect: whether it is on, and what called for it.
std::string explain(const EffectSet& effects);
Json to_json(const EffectSet& effects);

std::string text_of(const EffectsReport& report, const FrameRuns& frame);
Json to_json(const EffectsReport& report, const FrameRuns& frame);

}  // namespace coppice
