#pragma once

#include <array>
#include <map>
#include <mutex>

#include "coppice/build.h"
#include "gpu/command_writer.h"
#include "pipeline/checked_device.h"
#include "stages/hazards.h"

namespace coppice {

// What a Context holds.
class Context::State {
 public:
  State(const ContextOptions& options);
  State(const AdoptedDevice& device, const ContextOptions& options);

  Device& device() { return device_; }
  const Variants& variants() const { return variants_; }

  // The build's options of a use, after the device has been checked for it.
  BuildOptions checked(DeviceUse use);
  // The same for a trace of trees that any builder has made.
  TraceOptions checked(TraceOptions wanted);

 private:
  bool check(const DeviceUse& use);

  Device device_;
  Variants variants_;
  std::mutex check_mutex_;
  std::map<std::string, bool> verdicts_;  // by line_of the use
};

// The memory of a call, one for each kind of a Layout, and what it is at.
class CallMemory {
 public:
  explicit CallMemory(const Device& device) : device_(device) {}

  // Throws ArgumentError, with `what`, for a null buffer, fewer than `bytes`, or an address that is no
  // multiple of COPPICE_MEMORY_ALIGNMENT, or memory of another range of the call.
  void set(Memory memory, const MemoryRange& range, std::uint64_t bytes, const char* what);
  // Only read and written by kernels. Throws ArgumentError for null, unless there are no bytes, or
  // misaligned.
  void set(Memory memory, VkDeviceAddress address, std::uint64_t bytes, std::uint64_t alignment,
           const char* what);

  // A slot of its own for what lies at an address; an empty one for null.
  template <class T>
  Slot<T> slot_at(VkDeviceAddress address, std::uint64_t count) {
    if (address == 0) return {};
    addresses_.at(used_) = address;
    return {{used_++, 0}, count};
  }

  std::span<const std::uint64_t> addresses() const { return addresses_; }
  std::span<const BlockMemory> blocks() const { return blocks_; }

 private:
  const Device& device_;
  static constexpr std::size_t most_blocks = memory_kinds + 16;
  std::array<std::uint64_t, most_blocks> addresses_{};
  std::array<BlockMemory, most_blocks> blocks_{};
  std::array<std::uint64_t, memory_kinds> bytes_{};  // of ranges
  std::uint32_t used_ = memory_kinds;
};

// The address of a range; throws ArgumentError as CallMemory::set.
VkDeviceAddress checked_address(const Device& device, const MemoryRange& range, std::uint64_t bytes,
                                const char* what);

void check_count(const ElementCount& count, std::uint32_t maximum, const char* what);

// Throws ArgumentError unless `address` is a multiple of `alignment` and, where it must be, not null.
void check_address(VkDeviceAddress address, std::uint64_t alignment, bool may_be_null, const char* what);

// Records the steps of a chain as they come, with the times of all, if asked: then they stand apart.
class CommandSink : public StepSink {
 public:
  // The layout is that of the memory's kinds; both must outlive it.
  CommandSink(Device& device, VkCommandBuffer commands, const Layout& layout, const CallMemory& memory,
              KernelQueries* queries);
  ~CommandSink();
  void take(const Step& step) override;

 private:
  void stamp(const char* name);

  CommandWriter writer_;
  Hazards hazards_;
  KernelQueries* queries_;
  const char* open_ = nullptr;  // what has been recorded since the last timestamp: clears
};

// Compiles the kernels of a chain.
class PrepareSink : public StepSink {
 public:
  explicit PrepareSink(Device& device) : device_(device) {}
  void take(const Step& step) override;

 private:
  Device& device_;
};

// Calls `append(Chain&)` for a chain of no memory, so that all of its kernels are compiled.
template <class Append>
void prepare_chain(Device& device, Append append) {
  constexpr std::array<std::uint64_t, memory_kinds> nowhere{};
  PrepareSink sink(device);
  Chain chain(nowhere, &sink);
  append(chain);
}

// What the pipeline throws of options and sizes, as an ArgumentError.
template <class Action>
auto with_argument_errors(Action action) {
  try {
    return action();
  } catch (const std::invalid_argument& error) {
    throw ArgumentError(error.what());
  } catch (const LayoutError& error) {
    throw ArgumentError(error.what());
  }
}

}  // namespace coppice
