#include "stages/layout.h"

#include <algorithm>

#include "stages/divide_up.h"

namespace coppice {

void fail_to_fit(Place place, std::uint64_t slot_count, std::uint64_t count, std::uint64_t element_bytes) {
  throw LayoutError("upload of " + std::to_string(count) + " elements of " + std::to_string(element_bytes) +
                    " bytes into a slot of " + std::to_string(slot_count) + ", block " +
                    std::to_string(place.block) + ", offset " + std::to_string(place.offset));
}

Place Layout::reserve(SlotListing slot, Memory memory) {
  constexpr std::uint64_t alignment = 256;
  const std::uint64_t bytes = divide_up(slot.bytes(), alignment) * alignment + guard_bytes;
  if (bytes > max_block_bytes_) {
    throw LayoutError("'" + slot.name + "' needs " + std::to_string(bytes) +
                      " bytes in one piece, the device gives " + std::to_string(max_block_bytes_));
  }
  if (!apart_ && (block_bytes_.empty() || block_bytes_.back() + bytes > max_block_bytes_)) {
    block_bytes_.push_back(0);
    slot_ends_.emplace_back();
  }
  const auto block = static_cast<std::uint32_t>(apart_ ? std::size_t(memory) : block_bytes_.size() - 1);
  slot.place = {block, block_bytes_[block]};
  block_bytes_[block] += bytes;
  slot_ends_[block].push_back(block_bytes_[block]);
  slots_.push_back(slot);
  return slot.place;
}

std::uint64_t Layout::end_of_slot(Place place) const {
  return *std::ranges::upper_bound(slot_ends_[place.block], place.offset);
}

}  // namespace coppice
