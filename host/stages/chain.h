#pragma once

#include <array>
#include <cstring>
#include <type_traits>
#include <vector>

#include "interface/types.h"
#include "stages/divide_up.h"
#include "stages/layout.h"
#include "stages/stage.h"

namespace coppice {

// One step of a chain: a stage with its arguments; or, without a stage, zeroes written to a place; or,
// without bytes to clear either, a mark that splits the time.
struct Step {
  const StageDeclaration* stage = nullptr;
  std::array<std::byte, 128> args{};
  std::uint32_t args_bytes = 0;
  uvec3 groups{};
  bool indirect = false;
  Place place;  // of the workgroup counts of an indirect dispatch; of what is cleared
  std::uint64_t clear_bytes = 0;
  std::vector<std::uint32_t> specialization;  // constants 0, 1, ... of the kernel; never change its results
};

// Workgroups, `rows` rows of them, for `count` items, `size` to each column.
inline uvec3 groups_of(std::uint32_t count, std::uint32_t size, std::uint32_t rows = 1) {
  return {divide_up(count, size), rows, 1};
}

// A chain of stages, written once and run by any executor. It is resolved for one address space: the
// device's, where kernels run on it, or the host's, where twins do. A barrier precedes every step.
class Chain {
 public:
  explicit Chain(std::vector<std::uint64_t> block_addresses) : block_addresses_(std::move(block_addresses)) {}

  template <class T>
  Address<T> at(const Slot<T>& slot, std::uint64_t first = 0) const {
    return {block_addresses_.at(slot.place.block) + slot.place.offset + first * sizeof(T)};
  }

  template <class Args>
  void run(const Stage<Args>& stage, const Args& args, uvec3 groups,
           std::vector<std::uint32_t> specialization = {}) {
    if (groups.x == 0) return;
    Step& step = add(stage, args);
    step.groups = groups;
    step.specialization = std::move(specialization);
  }

  // As many workgroups as three words at `groups` say when the device gets there.
  template <class Args>
  void run_indirect(const Stage<Args>& stage, const Args& args, Place groups,
                    std::vector<std::uint32_t> specialization = {}) {
    Step& step = add(stage, args);
    step.indirect = true;
    step.place = groups;
    step.specialization = std::move(specialization);
  }

  template <class T>
  void clear(const Slot<T>& slot) {
    if (slot.count == 0) return;
    Step& step = steps_.emplace_back();
    step.place = slot.place;
    step.clear_bytes = (slot.bytes() + 3) / 4 * 4;
  }

  // Executors that measure report the time up to here.
  void mark() { steps_.emplace_back(); }

  const std::vector<Step>& steps() const { return steps_; }
  std::vector<Step>& steps() { return steps_; }

 private:
  template <class Args>
  Step& add(const Stage<Args>& stage, const Args& args) {
    static_assert(std::is_trivially_copyable_v<Args> && sizeof(Args) <= 128);
    Step& step = steps_.emplace_back();
    step.stage = &stage;
    step.args_bytes = sizeof(Args);
    std::memcpy(step.args.data(), &args, sizeof(Args));
    return step;
  }

  std::vector<std::uint64_t> block_addresses_;
  std::vector<Step> steps_;
};

}  // namespace coppice
