#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "interface/types.h"

namespace coppice {

// FNV-1a, 64 bits wide, over 32-bit words instead of bytes: h starts at 14695981039346656037, and each word
// makes it (h ^ word) * 1099511628211 modulo 2^64.

// Over the node array in memory order, eight words a node: box_min, child, box_max, height.
std::uint64_t tree_hash(std::span<const Node> nodes);

// Over the pixels in memory order.
std::uint64_t image_hash(std::span<const std::uint32_t> pixels);

// 16 lower-case hexadecimal digits, the most significant first.
std::string hex16(std::uint64_t hash);

}  // namespace coppice
