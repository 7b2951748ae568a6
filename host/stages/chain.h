#pragma once

#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "interface/types.h"
#include "stages/divide_up.h"
#include "stages/layout.h"
#include "stages/stage.h"

namespace coppice {

// Workgroups of a stage with its arguments.
struct Dispatch {
  const StageDeclaration* stage = nullptr;
  std::array<std::byte, 128> args{};
  std::uint32_t args_bytes = 0;
  uvec3 groups{};
  std::optional<Place> indirect{};  // where the device finds the number of workgroups, in place of `groups`
  KernelConstants constants{};      // never change a result
};

// Zeroes written to a place.
struct Clear {
  Place place;
  std::uint64_t bytes = 0;  // a multiple of 4
};

// Executors that measure report the time up to here.
struct Mark {};

using Step = std::variant<Dispatch, Clear, Mark>;

inline const Dispatch* dispatch_of(const Step& step) { return std::get_if<Dispatch>(&step); }
inline Dispatch* dispatch_of(Step& step) { return std::get_if<Dispatch>(&step); }

// Null for a step that is no stage's.
inline const StageDeclaration* stage_of(const Step& step) {
  const Dispatch* const dispatch = dispatch_of(step);
  return dispatch ? dispatch->stage : nullptr;
}

// The arguments of a step of this stage; null for a step of another.
template <class Args, class Constants>
const Args* args_of(const Step& step, const Stage<Args, Constants>& stage) {
  return stage_of(step) == &stage ? reinterpret_cast<const Args*>(std::get<Dispatch>(step).args.data())
                                  : nullptr;
}

// Workgroups, `rows` rows of them, for `count` items, `size` to each column.
inline uvec3 groups_of(std::uint32_t count, std::uint32_t size, std::uint32_t rows = 1) {
  return {divide_up(count, size), rows, 1};
}

// What takes the steps of a chain as they come.
class StepSink {
 public:
  virtual void take(const Step& step) = 0;

 protected:
  ~StepSink() = default;
};

// A chain of stages, written once and run by any executor. It is resolved for one address space: the
// device's, where kernels run on it, or the host's, where twins do. Each step sees what those before it
// wrote.
class Chain {
 public:
  // The addresses must outlive it. Steps are kept, or given to the sink, which allocates nothing.
  explicit Chain(std::span<const std::uint64_t> block_addresses, StepSink* sink = nullptr)
      : block_addresses_(block_addresses), sink_(sink) {}
  explicit Chain(std::vector<std::uint64_t>&&, StepSink* = nullptr) = delete;  // would be gone

  template <class T>
  Address<T> at(const Slot<T>& slot, std::uint64_t first = 0) const {
    return {block_addresses_[slot.place.block] + slot.place.offset + first * sizeof(T)};
  }

  template <class Args, class Constants>
  void run(const Stage<Args, Constants>& stage, const std::type_identity_t<Args>& args, uvec3 groups,
           const std::type_identity_t<Constants>& constants = {}) {
    if (groups.x == 0) return;
    add(dispatch_with(stage, args, constants, groups, std::nullopt));
  }

  // As many workgroups as three words at `groups` say when the device gets there.
  template <class Args, class Constants>
  void run_indirect(const Stage<Args, Constants>& stage, const std::type_identity_t<Args>& args, Place groups,
                    const std::type_identity_t<Constants>& constants = {}) {
    add(dispatch_with(stage, args, constants, {}, groups));
  }

  template <class T>
  void clear(const Slot<T>& slot) {
    if (slot.count > 0) add(Clear{slot.place, (slot.bytes() + 3) / 4 * 4});
  }

  void mark() { add(Mark{}); }

  // Empty with a sink.
  const std::vector<Step>& steps() const { return steps_; }
  std::vector<Step>& steps() { return steps_; }

 private:
  template <class Args, class Constants>
  static Dispatch dispatch_with(const Stage<Args, Constants>& stage, const Args& args,
                                const Constants& constants, uvec3 groups, std::optional<Place> indirect) {
    static_assert(std::is_trivially_copyable_v<Args> && sizeof(Args) <= 128);
    Dispatch dispatch{.stage = &stage,
                      .args_bytes = sizeof(Args),
                      .groups = groups,
                      .indirect = indirect,
                      .constants = KernelConstants(constants)};
    std::memcpy(dispatch.args.data(), &args, sizeof(Args));
    return dispatch;
  }

  void add(const Step& step) {
    if (sink_) {
      sink_->take(step);
    } else {
      steps_.push_back(step);
    }
  }

  std::span<const std::uint64_t> block_addresses_;
  StepSink* sink_;
  std::vector<Step> steps_;
};

}  // namespace coppice
