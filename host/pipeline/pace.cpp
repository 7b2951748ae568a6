#include "pipeline/pace.h"

#include <algorithm>

namespace coppice {

void Pace::note(std::uint64_t work, double ms) {
  if (work < work_ / 2 && ms < target_ms_) return;
  const double done = static_cast<double>(work), took = std::max(ms, 1e-3);
  recent_work_ = recent_work_ / 2 + done;
  recent_ms_ = recent_ms_ / 2 + took;
  // One submit of rays into the sky is no measure for those that follow.
  const double per_ms = std::min(done / took, 2 * recent_work_ / recent_ms_);
  constexpr double most_growth = 16;
  const double next = std::min(per_ms * target_ms_, most_growth * static_cast<double>(work_));
  work_ = static_cast<std::uint64_t>(std::clamp(next, 1.0, 1e15));
}

double submit_target_ms(const DeviceProperties& device) { return device.type == DeviceType::cpu ? 200 : 50; }

}  // namespace coppice
