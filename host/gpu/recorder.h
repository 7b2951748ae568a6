#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/arena.h"
#include "gpu/command_writer.h"

namespace coppice {

enum class Timestamps { total, every_step };

// Records steps into one command buffer of its own that can be submitted again and again.
class Recorder {
 public:
  // `step_limit`: at most so many steps and marks will be recorded.
  Recorder(Device& device, const Arena& arena, std::uint32_t step_limit, Timestamps timestamps);
  ~Recorder();
  Recorder(Recorder&&) noexcept;

  void dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                std::array<std::uint32_t, 3> groups);
  void dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push_constants, std::uint32_t block,
                         std::uint64_t offset);
  void clear(std::uint32_t block, std::uint64_t offset, std::uint64_t bytes);
  // As that of a CommandWriter.
  void barrier();
  // Notes the time between two steps, to split the total.
  void mark();

  struct Times {
    double total_ms;  // first to last timestamp; of the host clock where the device has none
    double wall_ms;   // host clock around submit and wait
    // Empty where the device has no timestamps.
    std::vector<double> marks_ms;  // from the start to each mark, in order
    std::vector<double> steps_ms;  // each step, in order; empty unless Timestamps::every_step, too
  };

  // Ends the recording at the first call; the submit before must be done. Returns the value of the device's
  // timeline when this one is.
  std::uint64_t submit();

  // Waits for the last submit and tells its times. Throws DeviceHung after the limit.
  Times wait(double limit_seconds);

  Times submit_and_wait(double limit_seconds) {
    submit();
    return wait(limit_seconds);
  }

 private:
  struct Commands;
  std::unique_ptr<Commands> commands_;
};

}  // namespace coppice
