#include "stages/layout.h"

#include "stages/divide_up.h"

namespace coppice {

void fail_to_fit(Place place, std::uint64_t slot_count, std::uint64_t count, std::uint64_t element_bytes) {
  throw LayoutError("upload of " + std::to_string(count) + " elements of " + std::to_string(element_bytes) +
                    " bytes into a slot of " + std::to_string(slot_count) + ", block " +
                    std::to_string(place.block) + ", offset " + std::to_string(place.offset));
}

Place Layout::reserve(SlotListing slot) {
  constexpr std::uint64_t alignment = 256;
  const std::uint64_t bytes = divide_up(slot.bytes(), alignment) * alignment + guard_bytes;
  if (bytes > max_block_bytes_) {
    throw LayoutError("'" + slot.name + "' needs " + std::to_string(bytes) +
                      " bytes in one piece, the device gives " + std::to_string(max_block_bytes_));
  }
  if (block_bytes_.empty() || block_bytes_.back() + bytes > max_block_bytes_) block_bytes_.push_back(0);
  slot.place = {static_cast<std::uint32_t>(block_bytes_.size() - 1), block_bytes_.back()};
  block_bytes_.back() += bytes;
  slots_.push_back(slot);
  return slot.place;
}

}  // namespace coppice
