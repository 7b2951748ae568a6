#pragma once

#include <cstdint>

#include "interface/alpha.h"
#include "stages/layout.h"

namespace coppice {

// Of a scene some of whose triangles let rays through; no maps: none do.
struct AlphaCounts {
  std::uint32_t maps = 0;
  std::uint64_t texel_words = 0;

  bool operator==(const AlphaCounts&) const = default;
};

// What traces with alpha take; all empty where there is none.
struct AlphaSlots {
  Slot<AlphaTriangle> triangles;  // in
  Slot<AlphaMap> maps;            // in
  Slot<uint> texels;              // in

  bool any() const { return maps.count != 0; }
};

// Throws LayoutError if a slot does not fit a block.
inline AlphaSlots plan_alpha(Layout& layout, const AlphaCounts& counts, std::uint32_t triangle_count) {
  AlphaSlots slots;
  if (counts.maps == 0) return slots;
  slots.triangles = layout.add<AlphaTriangle>("alpha_triangles", triangle_count);
  slots.maps = layout.add<AlphaMap>("alpha_maps", counts.maps);
  slots.texels = layout.add<uint>("alpha_texels", counts.texel_words);
  return slots;
}

}  // namespace coppice
