#include "render/update_chooser.h"

#include <algorithm>

namespace coppice {

namespace {

constexpr double smoothing = 0.25;  // the part that the newest frame has in a smoothed time

void smooth(std::optional<double>& mean, double value) {
  mean = mean ? *mean + (value - *mean) * smoothing : value;
}

}  // namespace

bool UpdateChooser::next_refits() {
  bool refits = built_;
  if (update_ == Update::rebuild) refits = false;
  if (refits && update_ == Update::automatic) {
    if (held_ > 0) {
      --held_;
      refits = false;
    } else {
      refits = pending_builds_ > 0 || another_refit_pays();
    }
  }
  built_ = true;
  pending_builds_ += !refits;
  return refits;
}

bool UpdateChooser::another_refit_pays() const {
  if (cycle_frames_ < 2 || !refit_ms_ || !ms_a_step_) return true;  // nothing is known of a refit yet
  const double next_steps = last_steps_ + std::max(growth_, 0.0);
  return *refit_ms_ + next_steps * *ms_a_step_ < cycle_ms_ / cycle_frames_;
}

// After a cycle whose refitted frames cost more than its built one.
void UpdateChooser::hold_back(const Frame& frame) {
  if (cycle_frames_ < 2 && !frame.was_refitted_in_vain) return;
  const bool in_vain = frame.was_refitted_in_vain || cycle_ms_ >= cycle_frames_ * built_ms_;
  hold_ = in_vain ? std::min(std::max(2 * hold_, 4u), most_held) : 0;
  held_ = hold_;
}

void UpdateChooser::note(const Frame& frame) {
  const auto steps = static_cast<double>(frame.steps);
  if (steps > 0) smooth(ms_a_step_, frame.trace_ms / steps);
  if (frame.rebuilt) {
    // Those that triangles asked for nobody had decided on.
    if (!frame.was_refitted_in_vain) pending_builds_ -= pending_builds_ > 0;
    hold_back(frame);
    built_ms_ = frame.update_ms + frame.trace_ms;
    cycle_ms_ = 0;
    cycle_frames_ = 0;
    growth_ = 0;
  } else {
    smooth(refit_ms_, frame.update_ms);
    growth_ = steps - last_steps_;
  }
  last_steps_ = steps;
  cycle_ms_ += frame.update_ms + frame.trace_ms;
  ++cycle_frames_;
}

}  // namespace coppice
