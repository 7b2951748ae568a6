#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/self_check.h"
#include "stages/cpu_executor.h"
#include "stages/gpu_executor.h"
#include "stages/layout.h"

namespace coppice {

// A chain that the device runs and the twins run, and what both must leave alike.
class CheckChain {
 public:
  explicit CheckChain(std::uint64_t max_block_bytes) : layout_(max_block_bytes) {}

  Layout& layout() { return layout_; }
  const Layout& layout() const { return layout_; }

  template <class T>
  void upload(const Slot<T>& slot, std::span<const T> values) {
    check_fits(slot, values.size());
    const auto bytes = std::as_bytes(values);
    uploads_.push_back({slot.place, {bytes.begin(), bytes.end()}});
  }

  template <class T>
  Slot<T> add(const char* name, const std::vector<T>& values) {
    const Slot<T> slot = layout_.add<T>(name, values.size());
    upload(slot, std::span(values));
    return slot;
  }

  // Steps of the chain, behind those of the calls before.
  void append(std::function<void(Chain&)> steps) { parts_.push_back({std::move(steps), true}); }
  // Steps that only the twins run; what they leave in the slots that are `handed_over` the device gets.
  void append_by_twins(std::function<void(Chain&)> steps) { parts_.push_back({std::move(steps), false}); }
  template <class T>
  void hand_over(const Slot<T>& slot) {
    handed_over_.push_back({slot.place, slot.bytes()});
  }

  // What the chain leaves there is compared: bit for bit, or on a device that does not round like the host as
  // `like` says. `wrong` says what a device does that leaves anything else.
  template <class T>
  void compare(const Slot<T>& slot, const char* wrong, std::optional<Nearly> like = {}) {
    compared_.push_back({{slot.place, slot.bytes()}, wrong, like});
  }

  // All of it, for the twins.
  void upload_to(CpuExecutor& executor) const;
  void append_to(Chain& chain) const;

  // The first thing that the device does wrong; null where it does nothing wrong.
  const char* run(Device& device, const CheckFault& fault) const;

 private:
  struct Bytes {
    Place place;
    std::uint64_t count;
  };
  struct Upload {
    Place place;
    std::vector<std::byte> bytes;
  };
  struct Part {
    std::function<void(Chain&)> steps;
    bool on_device;
  };
  struct Compared {
    Bytes bytes;
    const char* wrong;
    std::optional<Nearly> like;
  };

  bool same(const Device& device, const Compared& compared, std::span<const std::byte> by_twins,
            std::span<const std::byte> on_device) const;

  Layout layout_;
  std::vector<Upload> uploads_;
  std::vector<Part> parts_;
  std::vector<Bytes> handed_over_;
  std::vector<Compared> compared_;
};

// The chain of a use, for a small scene.
CheckChain check_chain_of(const DeviceProperties& device, const DeviceUse& use, bool lookback);

}  // namespace coppice
