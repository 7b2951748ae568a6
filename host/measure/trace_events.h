#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "measure/kernel_times.h"

namespace coppice {

// Chrome trace events of timed runs, one behind the other.
class TraceEvents {
 public:
  // A viewer takes no more, and neither does memory: what comes later is left out, with a note.
  static constexpr std::size_t most_events = 1u << 20;

  void add(std::span<const Step> steps, const Recorder::Times& times);
  void add(const KernelSplit& split) { add(split.steps, split.times); }

  // Throws InputError naming the file; nothing for "". Notes go to the device's.
  void write(const std::string& path, const CheckedDevice& device) const;

 private:
  struct Event {
    const char* name;
    double ms;
  };
  std::vector<Event> events_;
  std::uint64_t left_out_ = 0;
};

}  // namespace coppice
