#pragma once

#include <functional>
#include <optional>
#include <string>

#include "stages/cpu_executor.h"
#include "stages/gpu_executor.h"

namespace coppice {

struct Difference {
  std::string stage;
  std::string slot;      // or the guard behind it
  std::uint64_t index;   // of the element; at least the slot's count in its guard
  std::string cpu, gpu;  // the element's words in hexadecimal
};

// Runs a chain on a device and by its twins, on the same input, one stage at a time, and compares all memory
// of both bit for bit after every stage, guards included.
class LockstepExecutor {
 public:
  LockstepExecutor(Device& device, const Layout& layout)
      : layout_(layout), gpu_(device, layout), cpu_(layout) {}

  template <class T>
  void upload(const Slot<T>& slot, std::span<const T> values) {
    gpu_.upload(slot, values);
    cpu_.upload(slot, values);
  }

  // Stages that compare only nearly (shading on a GPU) are judged by `tolerate`, which returns true to go on:
  // then the device's bits are taken over.
  using Tolerate = std::function<bool(const Difference&)>;

  // Appends to both chains alike; returns the first difference, if any.
  std::optional<Difference> run(const std::function<void(Chain&)>& append, const Tolerate& tolerate = {});

  std::uint32_t stages_run() const { return stages_run_; }
  const CpuExecutor& cpu() const { return cpu_; }
  const GpuExecutor& gpu() const { return gpu_; }

 private:
  std::optional<Difference> compare(const char* stage);
  void take_over_device_memory();

  Layout layout_;
  GpuExecutor gpu_;
  CpuExecutor cpu_;
  std::uint32_t stages_run_ = 0;
};

}  // namespace coppice
