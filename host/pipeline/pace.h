#pragma once

#include <cstdint>

#include "gpu/device.h"

namespace coppice {

// How much work the next submit may have, so that it takes about `target_ms`: from the times of those before.
// It starts small, grows by steps, and shrinks at once. What work is, the caller says. Only times depend on
// it, never results.
class Pace {
 public:
  Pace(double target_ms, std::uint64_t first_work) : target_ms_(target_ms), work_(first_work) {}

  std::uint64_t work() const { return work_; }
  double target_ms() const { return target_ms_; }

  // A submit of so much work took so long. Less than half of work() says little, unless it took too long.
  void note(std::uint64_t work, double ms);

 private:
  double target_ms_;
  std::uint64_t work_;
  double recent_work_ = 0, recent_ms_ = 0;  // the older, the less they count
};

// What watchdogs and people who press Ctrl-C bear.
double submit_target_ms(const DeviceProperties& device);

}  // namespace coppice
