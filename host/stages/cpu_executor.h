#pragma once

#include <memory>
#include <span>
#include <vector>

#include "stages/chain.h"

namespace coppice {

// Runs chains by their twins, on host memory of the same layout.
class CpuExecutor {
 public:
  explicit CpuExecutor(const Layout& layout);

  Chain chain() const { return Chain(addresses_); }
  std::span<const std::uint64_t> block_addresses() const { return addresses_; }

  // A mark, or an indirect dispatch whose number of workgroups is now 0.
  bool does_nothing(const Step& step) const;

  void run(const Step& step);
  void run(std::span<const Step> steps) {
    for (const Step& step : steps) run(step);
  }

  // Throws LayoutError for more values than the slot holds.
  template <class T>
  void upload(const Slot<T>& slot, std::span<const T> values) {
    check_fits(slot, values.size());
    if (!values.empty()) std::memcpy(at(slot.place), values.data(), values.size_bytes());
  }

  template <class T>
  std::vector<T> read(const Slot<T>& slot) const {
    std::vector<T> values(slot.count);
    if (!values.empty()) std::memcpy(values.data(), at(slot.place), slot.bytes());
    return values;
  }

  std::byte* at(Place place) const {
    return reinterpret_cast<std::byte*>(blocks_.at(place.block).get()) + place.offset;
  }

 private:
  std::vector<std::unique_ptr<std::uint64_t[]>> blocks_;
  std::vector<std::uint64_t> addresses_;
};

}  // namespace coppice
