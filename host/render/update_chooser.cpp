#include "render/update_chooser.h"

#include <algorithm>

namespace coppice {

namespace {

constexpr double smoothing = 0.25;  // the part that the newest frame has in a smoothed time

// Of steps, below which it says nothing of its cause.
constexpr double least_growth = 0.01;

// Some of it is always taken for the tree's, so that builds are tried again.
constexpr double least_share = 0.05;

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
  const double growth = last_steps_ + std::max(growth_, 0.0) - first_steps_;
  const double of_scene = 1 - aged_share_;
  const double next_ms = *refit_ms_ + (first_steps_ + aged_share_ * growth) * *ms_a_step_;
  const double grown = cycle_steps_ - first_steps_ * cycle_frames_;
  return next_ms < (cycle_ms_ - of_scene * grown * *ms_a_step_) / cycle_frames_;
}

// From a build that followed refits: what it took back of the steps by which they had grown.
void UpdateChooser::learn_share(double steps) {
  const double grown = last_steps_ - first_steps_;
  if (cycle_frames_ < 2 || !(grown > least_growth * first_steps_)) return;
  const double share = std::clamp((last_steps_ - steps) / grown, least_share, 1.0);
  aged_share_ += (share - aged_share_) / 2;
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
    learn_share(steps);
    first_steps_ = steps;
    cycle_steps_ = 0;
    built_ms_ = frame.update_ms + frame.trace_ms;
    cycle_ms_ = 0;
    cycle_frames_ = 0;
    growth_ = 0;
  } else {
    smooth(refit_ms_, frame.update_ms);
    growth_ = steps - last_steps_;
  }
  last_steps_ = steps;
  cycle_steps_ += steps;
  cycle_ms_ += frame.update_ms + frame.trace_ms;
  ++cycle_frames_;
}

}  // namespace coppice
