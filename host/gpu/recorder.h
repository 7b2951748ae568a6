#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/arena.h"

namespace coppice {

struct Kernel {
  const char* name;
  std::span<const std::uint32_t> spirv;
  std::span<const std::uint32_t> specialization;  // constants 0, 1, ...
};

enum class Timestamps { total, every_step };

// Records steps into one command buffer that can be submitted again and again. A barrier precedes every step.
class Recorder {
 public:
  // `step_limit`: at most so many steps will be recorded.
  Recorder(Device& device, const Arena& arena, std::uint32_t step_limit, Timestamps timestamps);
  ~Recorder();
  Recorder(Recorder&&) noexcept;

  void dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                std::array<std::uint32_t, 3> groups);
  void dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push_constants, std::uint32_t block,
                         std::uint64_t offset);
  void clear(std::uint32_t block, std::uint64_t offset, std::uint64_t bytes);
  // Notes the time between two steps, to split the total.
  void mark();

  struct Times {
    double total_ms;  // first to last timestamp; of the host clock where the device has none
    double wall_ms;   // host clock around submit and wait
    // Empty where the device has no timestamps.
    std::vector<double> marks_ms;  // from the start to each mark, in order
    std::vector<double> steps_ms;  // each step, in order; empty unless Timestamps::every_step, too
  };

  // Ends the recording at the first call. A device that is not done within the limit ends the program, with
  // one line.
  Times submit_and_wait(double limit_seconds);

 private:
  struct Commands;
  std::unique_ptr<Commands> commands_;
};

}  // namespace coppice
