#pragma once

#include <cstdint>
#include <vector>

#include "gpu/device.h"
#include "interface/copy.h"
#include "stages/chain.h"
#include "stages/layout.h"

namespace coppice {

struct CopyPlan {
  Slot<uvec4> source, target;
};

// For copies that move at most `most_bytes`, read and written together. Throws LayoutError if a slot does not
// fit a block.
CopyPlan plan_copy(Layout& layout, std::uint64_t most_bytes);

// A copy that moves `bytes`, rounded up to 32; at most what the plan is for.
void append_copy(Chain& chain, const CopyPlan& plan, std::uint64_t bytes);

// What a device takes for plain copies by the stage copy_words: the limit for stages that only move memory.
class CopyLimit {
 public:
  struct Measurement {
    std::uint64_t bytes;  // read and written
    double ms;
  };

  // Bytes and times from the smallest to the largest copy; at least one.
  explicit CopyLimit(std::vector<Measurement> measurements) : measurements_(std::move(measurements)) {}

  // What a dispatch that copies takes to move `bytes`: linear between the sizes that were measured; the
  // smallest copy's time below them; at the largest copy's rate above.
  double ms(std::uint64_t bytes) const;

  const std::vector<Measurement>& measurements() const { return measurements_; }

 private:
  std::vector<Measurement> measurements_;
};

// Measures copies of 4 KiB to the first power of four times that which reaches `most_bytes`, at most 256 MiB:
// the median of five runs of each, after one more, with a timestamp after each dispatch. The host's clock
// tells no dispatches apart, so a device without timestamps has no limit: throws DeviceError, as it does if
// there is no memory left.
CopyLimit measure_copy_limit(Device& device, std::uint64_t most_bytes);

}  // namespace coppice
