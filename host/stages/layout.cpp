#include "stages/layout.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "stages/divide_up.h"

namespace coppice {

void fail_to_fit(Place place, std::uint64_t slot_count, std::uint64_t count, std::uint64_t element_bytes) {
  throw LayoutError("upload of " + std::to_string(count) + " elements of " + std::to_string(element_bytes) +
                    " bytes into a slot of " + std::to_string(slot_count) + ", block " +
                    std::to_string(place.block) + ", offset " + std::to_string(place.offset));
}

std::uint64_t Layout::bytes_with_guard(const SlotListing& slot) const {
  constexpr std::uint64_t alignment = 256;
  const std::uint64_t bytes = divide_up(slot.bytes(), alignment) * alignment + guard_bytes;
  if (bytes <= max_block_bytes_) return bytes;
  throw LayoutError("'" + slot.name + "' needs " + std::to_string(bytes) +
                    " bytes in one piece, the device gives " + std::to_string(max_block_bytes_));
}

Place Layout::reserve(SlotListing slot, Memory memory) {
  if (!apart_) return reserve_in(std::move(slot), false);
  const std::uint64_t bytes = bytes_with_guard(slot);
  return place_in(static_cast<std::uint32_t>(memory), std::move(slot), bytes);
}

// In the last block of its sort that has room, or a new one.
Place Layout::reserve_in(SlotListing slot, bool mapped) {
  if (apart_) throw std::logic_error("a mapped slot where kinds of memory lie apart");
  const std::uint64_t bytes = bytes_with_guard(slot);
  std::size_t block = mapped_.size();
  while (block > 0 && mapped_[block - 1] != mapped) --block;
  if (block == 0 || block_bytes_[block - 1] + bytes > max_block_bytes_) {
    block_bytes_.push_back(0);
    slot_ends_.emplace_back();
    mapped_.push_back(mapped);
    block = mapped_.size();
  }
  return place_in(static_cast<std::uint32_t>(block - 1), std::move(slot), bytes);
}

Place Layout::place_in(std::uint32_t block, SlotListing slot, std::uint64_t bytes) {
  slot.place = {block, block_bytes_[block]};
  block_bytes_[block] += bytes;
  slot_ends_[block].push_back(block_bytes_[block]);
  slots_.push_back(std::move(slot));
  return slots_.back().place;
}

std::uint64_t Layout::end_of_slot(Place place) const {
  return *std::ranges::upper_bound(slot_ends_[place.block], place.offset);
}

}  // namespace coppice
