#pragma once

#include <functional>
#include <set>
#include <string>

#include "gpu/device.h"
#include "pipeline/self_check.h"
#include "pipeline/walk.h"

namespace coppice {

// Takes a line that is worth knowing and no error.
using Note = std::function<void(const std::string&)>;

// Prefix sums by decoupled lookback; automatic: where the self-check finds that it works.
enum class LookbackChoice { automatic, on, off };

// What a caller insists on, or leaves to the device.
struct DeviceChoices {
  LookbackChoice lookback = LookbackChoice::automatic;
  // "auto": as tuned, or else by rule; "default": by rule; "STAGE=VALUE,...": these, the others by rule.
  std::string variants = "auto";
  WalkChoice walk{};
  std::string slow_driver_remedy{};  // said of a driver of which a much faster one exists
};

// `wanted` with the turns that the device's loops may take.
TraceOptions within_loop_turns(TraceOptions wanted, const DeviceProperties& device);

// A device that has passed the self-check, and what it asks of plans: the variants of stages, lookback, the
// turns that its loops may take, the walk through a tree.
class CheckedDevice {
 public:
  // Checks what `use` says, with the variants and the walks that are chosen here. Notes go to `note`, and to
  // `waiting` what explains a wait that has just begun. Throws DeviceError if there is no such device or it
  // fails, std::invalid_argument for choices that cannot be had.
  CheckedDevice(const DeviceOptions& options, const DeviceChoices& choices, DeviceUse use, Note note = {},
                const Note& waiting = {});
  // The same of a device that is there; it has a queue.
  CheckedDevice(Device device, const DeviceChoices& choices, DeviceUse use, Note note = {},
                const Note& waiting = {});

  Device& device() { return device_; }
  const DeviceProperties& properties() const { return device_.properties(); }
  bool lookback() const { return lookback_; }
  const Variants& variants() const { return variants_; }
  void set_variants(const Variants& variants) { variants_ = variants; }
  void set_walk(const WalkChoice& walk) { walk_ = walk; }

  // `wanted` with lookback and variants.
  BuildOptions build_options(BuildOptions wanted) const;

  // `wanted` with the turns of loops.
  TraceOptions trace_options(TraceOptions wanted) const;

  // The same, with the walk for a picture of a scene of so many triangles. Brute force stays so.
  TraceOptions picture_options(TraceOptions wanted, std::uint32_t triangle_count) const;

  // Through the wide tree as the variant of the stage trace says, or else as suits the device.
  Walk wide_walk() const;

  const Note& notes() const { return note_; }
  void note(const std::string& line) const;
  void note_once(const std::string& line);

 private:
  Note note_;
  std::set<std::string> said_;
  Device device_;
  WalkChoice walk_;
  bool lookback_ = true;
  Variants variants_;
};

}  // namespace coppice
