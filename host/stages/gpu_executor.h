#pragma once

#include <span>
#include <vector>

#include "gpu/arena.h"
#include "gpu/recorder.h"
#include "stages/chain.h"

namespace coppice {

// Runs chains on a device: records them once into a command buffer that can be submitted every frame.
class GpuExecutor {
 public:
  // Allocates the layout's blocks. Throws DeviceError when they do not fit.
  GpuExecutor(Device& device, const Layout& layout)
      : device_(device), layout_(layout), arena_(device, layout.block_bytes(), layout.mapped_blocks()) {}

  Chain chain() const { return Chain(arena_.block_addresses()); }

  // Steps that do not depend on each other overlap, unless every step is timed.
  Recorder record(std::span<const Step> steps, Timestamps timestamps = Timestamps::total);

  // Throws LayoutError for more values than the slot holds.
  template <class T>
  void upload(const Slot<T>& slot, std::span<const T> values) {
    check_fits(slot, values.size());
    arena_.upload(slot.place.block, slot.place.offset, std::as_bytes(values));
  }

  template <class T>
  std::vector<T> read(const Slot<T>& slot) const {
    std::vector<T> values(slot.count);
    arena_.download(slot.place.block, slot.place.offset, std::as_writable_bytes(std::span(values)));
    return values;
  }

  Arena& arena() { return arena_; }

 private:
  Device& device_;
  Layout layout_;
  Arena arena_;
};

}  // namespace coppice
