#pragma once

#include "interface/trace.h"

namespace coppice::twins {

// Adds to a 64-bit sum of two words.
inline void count_into(uvec2& counter, std::uint64_t value) {
  const std::uint64_t sum = (std::uint64_t{counter.y} << 32 | counter.x) + value;
  counter = {static_cast<uint>(sum), static_cast<uint>(sum >> 32)};
}

}  // namespace coppice::twins
