#pragma once

#include <functional>
#include <optional>
#include <string>

#include "stages/cpu_executor.h"
#include "stages/gpu_executor.h"
#include "stages/nearly.h"

namespace coppice {

struct Difference {
  std::string stage;     // or "clear", "steps of no workgroups", or "upload" before the first step
  std::string slot;      // or what lies behind it, up to the next
  std::uint64_t index;   // of the element; at least the slot's count behind it
  std::string cpu, gpu;  // the element's words in hexadecimal
  std::string why;       // where more differ than the stage's tolerance allows; else empty
};

// What a stage left nearly equal in a slot, over all its runs.
struct NearlyListing {
  const char* stage;
  const char* slot;
  NearlyEqual sum;  // counts and limits added up
};

// Runs a chain on a device and by its twins, on the same input, one step at a time, and compares all memory
// of both after every step bit for bit: slots, guards and what lies between. Indirect dispatches in a row
// that come to no workgroups (levels beyond the last, rounds behind the end) are one step. Where the device
// is no CPU, slots that a stage declares as nearly equal are held to their tolerance (stages/nearly.h); then
// the device's bits are taken over, so that no stage is blamed for what came before it.
class LockstepExecutor {
 public:
  LockstepExecutor(Device& device, const Layout& layout);

  template <class T>
  void upload(const Slot<T>& slot, std::span<const T> values) {
    gpu_.upload(slot, values);
    cpu_.upload(slot, values);
  }

  // Appends to both chains alike; returns the first difference, if any.
  std::optional<Difference> run(const std::function<void(Chain&)>& append);

  std::uint32_t stages_run() const { return stages_run_; }
  // Empty on a CPU device, where every bit is compared.
  std::span<const NearlyListing> nearly() const { return nearly_; }
  const Layout& layout() const { return layout_; }
  const CpuExecutor& cpu() const { return cpu_; }
  const GpuExecutor& gpu() const { return gpu_; }

 private:
  std::optional<Difference> compare(const StageDeclaration* stage, const char* name);
  std::optional<Difference> compare_bits(const char* name, const SlotListing& slot, std::uint64_t first,
                                         std::uint64_t end);
  std::optional<Difference> compare_slot(const StageDeclaration& stage, const NearlySlot& nearly,
                                         const SlotListing& slot);

  Layout layout_;
  GpuExecutor gpu_;
  CpuExecutor cpu_;
  bool every_bit_;
  std::uint32_t stages_run_ = 0;
  std::vector<NearlyListing> nearly_;
};

}  // namespace coppice
