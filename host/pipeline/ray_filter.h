#pragma once

#include <cstdint>

#include "interface/trace.h"
#include "pipeline/alpha.h"
#include "stages/chain.h"

namespace coppice {

// What the rays of a trace see and how many there are, as TraceClosestArgs has it, and where triangles let
// them through. Empty slots say nothing.
struct RayFilter {
  Slot<uint> primitive_flags;  // in: one a primitive
  Slot<uint> ray_masks;        // in: one a ray
  Slot<uint> count_at;         // in: one word
  std::uint32_t ray_mask = PRIMITIVE_MASK;
  AlphaSlots alpha{};

  // Whether some ray may not see some primitive, or some primitive may not be opaque.
  bool masks() const {
    return primitive_flags.count != 0 || ray_masks.count != 0 || (ray_mask & PRIMITIVE_MASK) == 0;
  }
};

// Null for an empty slot.
template <class T>
Address<T> address_or_null(const Chain& chain, const Slot<T>& slot, std::uint64_t first = 0) {
  return slot.count == 0 ? Address<T>{} : chain.at(slot, first);
}

}  // namespace coppice
