#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interface/types.h"

namespace coppice {

// Codes of `bits_per_axis` bits for each axis, 1 to 21: a code of 3 * bits_per_axis bits, of which bit
// 3i + 2 is bit i of the x cell, bit 3i + 1 of y and bit 3i of z. The cells are cubes whose side is a power
// of two, the grid starts at the smallest corner of all boxes, and a box lies in the cell of its centre.
// Boxes are in normalised space (NormalisedSpace).
std::vector<std::uint64_t> morton_codes(std::span<const Aabb> boxes, int bits_per_axis);

// The stable order of the codes: indices into `codes`, ascending by (code, index). LSD radix sort; only the
// lowest `code_bits` bits of a code may be set, 1 to 64.
std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> codes, int code_bits);

}  // namespace coppice
