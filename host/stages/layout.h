#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace coppice {

// Who keeps a slot. It matters only where these lie apart: each is a block of its own then.
enum class Memory : std::uint32_t { scratch, tree, keys, values, source, target, update };
inline constexpr std::uint32_t memory_kinds = 7;

// A position in device or host memory, before it has an address.
struct Place {
  std::uint32_t block = 0;
  std::uint64_t offset = 0;
};

// An array of T that stages read and write.
template <class T>
struct Slot {
  Place place;
  std::uint64_t count = 0;

  std::uint64_t bytes() const { return count * sizeof(T); }
};

struct SlotListing {
  std::string name;
  Place place;
  std::uint64_t count;
  std::uint64_t element_bytes;

  std::uint64_t bytes() const { return count * element_bytes; }
};

struct LayoutError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[noreturn]] void fail_to_fit(Place place, std::uint64_t slot_count, std::uint64_t count,
                              std::uint64_t element_bytes);

// Throws LayoutError, with both counts, if the slot does not hold so many elements.
template <class T>
void check_fits(const Slot<T>& slot, std::uint64_t count) {
  if (count > slot.count) fail_to_fit(slot.place, slot.count, count, sizeof(T));
}

// Hands out places for slots, in blocks no larger than a device allocates at once. Behind every slot lies a
// guard, so that a write past the end of one is seen and is not another's first word.
class Layout {
 public:
  static constexpr std::uint64_t guard_bytes = 256;

  explicit Layout(std::uint64_t max_block_bytes = std::uint64_t{1} << 30)
      : max_block_bytes_(max_block_bytes) {}

  // With a block for each kind of memory, in their order, whoever gives it.
  static Layout apart(std::uint64_t max_block_bytes) {
    Layout layout(max_block_bytes);
    layout.apart_ = true;
    layout.block_bytes_.resize(memory_kinds);
    layout.slot_ends_.resize(memory_kinds);
    layout.mapped_.resize(memory_kinds);
    return layout;
  }

  // Throws LayoutError if the slot alone is larger than a block may be.
  template <class T>
  Slot<T> add(const std::string& name, std::uint64_t count, Memory memory = Memory::scratch) {
    return {reserve({name, {}, count, sizeof(T)}, memory), count};
  }

  // A slot that the host maps, in a block of such slots: what it tells a frame, and what a frame tells it.
  // Not where kinds of memory lie apart.
  template <class T>
  Slot<T> add_mapped(const std::string& name, std::uint64_t count) {
    return {reserve_in({name, {}, count, sizeof(T)}, true), count};
  }

  const std::vector<bool>& mapped_blocks() const { return mapped_; }  // one a block

  // Of a layout whose kinds of memory lie apart.
  std::uint64_t bytes_of(Memory memory) const { return block_bytes_.at(static_cast<std::size_t>(memory)); }

  // Offset in the block where the slot at this place, its guard too, has its end.
  std::uint64_t end_of_slot(Place place) const;

  const std::vector<std::uint64_t>& block_bytes() const { return block_bytes_; }
  const std::vector<SlotListing>& slots() const { return slots_; }

 private:
  std::uint64_t bytes_with_guard(const SlotListing& slot) const;
  Place reserve(SlotListing slot, Memory memory);
  Place reserve_in(SlotListing slot, bool mapped);
  Place place_in(std::uint32_t block, SlotListing slot, std::uint64_t bytes);

  std::uint64_t max_block_bytes_;
  bool apart_ = false;
  std::vector<std::uint64_t> block_bytes_;
  std::vector<bool> mapped_;                           // by block
  std::vector<std::vector<std::uint64_t>> slot_ends_;  // by block, ascending
  std::vector<SlotListing> slots_;
};

}  // namespace coppice
