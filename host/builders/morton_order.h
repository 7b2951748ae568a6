#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interface/types.h"

namespace coppice {

class Threads;

// Codes of `bits_per_axis` bits for each axis, 1 to 21: a code of 3 * bits_per_axis bits, of which bit
// 3i + 2 is bit i of the x cell, bit 3i + 1 of y and bit 3i of z. The cells are cubes whose side is a power
// of two, the grid starts at the smallest corner of the scene's box, and a box lies in the cell of its
// centre. Boxes are in normalised space (NormalisedSpace).
class MortonGrid {
 public:
  MortonGrid(const Aabb& scene, int bits_per_axis);

  std::uint64_t code_of(const Aabb& box) const;

 private:
  vec3 origin_;
  float cells_per_unit_ = 0.0f;
};

// The codes of the boxes on the grid of them all.
std::vector<std::uint64_t> morton_codes(std::span<const Aabb> boxes, int bits_per_axis);

// The stable order of the codes: indices into `codes`, ascending by (code, index). LSD radix sort; only the
// lowest `code_bits` bits of a code may be set, 1 to 64.
std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> codes, int code_bits);
std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> codes, int code_bits,
                                        const Threads& threads);

}  // namespace coppice
