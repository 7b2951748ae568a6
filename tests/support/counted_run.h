#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {

// What a test fills memory with that nothing is to write to.
inline constexpr uint SENTINEL = 0xabadcafe;

// A layout with a word for a count, and what runs it in lockstep.
struct CountedRun {
  Layout layout{test_device().properties().max_block_bytes};
  Slot<uint> count = layout.add<uint>("count", 1);
  std::optional<LockstepExecutor> executor;

  // After the layout is complete.
  void start(uint count_there = 0) {
    executor.emplace(test_device(), layout);
    executor->upload(count, std::span<const uint>(&count_there, 1));
  }

  template <class T>
  void upload(const Slot<T>& slot, const std::vector<T>& values) {
    executor->upload(slot, std::span<const T>(values));
  }

  template <class T>
  void fill(const Slot<T>& slot) {
    const std::vector<uint> words(slot.bytes() / 4, SENTINEL);
    executor->upload(Slot<uint>{slot.place, words.size()}, std::span<const uint>(words));
  }

  void expect_same_bits(const std::function<void(Chain&)>& append) {
    const auto difference = executor->run(append);
    ASSERT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index
                             << "]: cpu " << difference->cpu << ", gpu " << difference->gpu;
  }

  template <class T>
  std::vector<T> read(const Slot<T>& slot) const {
    return executor->gpu().read(slot);
  }
};

}  // namespace coppice
