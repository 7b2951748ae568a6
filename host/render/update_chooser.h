#pragma once

#include <cstdint>
#include <optional>

namespace coppice {

enum class Update { rebuild, refit, automatic };

// Whether the tree of a frame is built anew or refitted. `automatic` makes update and trace together take
// least, by what frames are measured to take; docs/frames.md has the rule and where it comes from.
class UpdateChooser {
 public:
  explicit UpdateChooser(Update update) : update_(update) {}

  // Decides for the next frame, in the order in which frames are submitted. The first one is built.
  bool next_refits();

  struct Frame {
    bool rebuilt = true;
    bool was_refitted_in_vain = false;  // before, as triangles had appeared
    double update_ms = 0;               // to the tree that is traced
    double trace_ms = 0;
    std::uint64_t steps = 0;  // of its rays
  };

  // What a frame took, in the same order.
  void note(const Frame& frame);

  // Refits that would cost more than builds are tried again after so many built frames, at most.
  static constexpr std::uint32_t most_held = 64;

 private:
  bool another_refit_pays() const;
  void hold_back(const Frame& frame);
  void learn_share(double steps);

  Update update_;
  bool built_ = false;                 // the first frame has been decided on
  std::uint32_t pending_builds_ = 0;   // decided on, and not noted yet
  std::uint32_t held_ = 0, hold_ = 0;  // built frames before refits are tried again: left, and at first

  // Smoothed over frames; none before the first one.
  std::optional<double> refit_ms_, ms_a_step_;

  // Since the last build.
  double built_ms_ = 0;  // update and trace of the frame that was built
  double cycle_ms_ = 0;  // update and trace of all frames, the built one too
  std::uint32_t cycle_frames_ = 0;
  double last_steps_ = 0, growth_ = 0;        // of steps, from frame to frame
  double first_steps_ = 0, cycle_steps_ = 0;  // of the frame that was built; of all frames

  // The part of what steps grow by that a build takes back; the rest is the scene's.
  double aged_share_ = 1;
};

}  // namespace coppice
