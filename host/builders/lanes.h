#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace coppice {

// Vectors of GCC and Clang: every operation is that of a lane, and a comparison gives all bits or none.
// Four lanes are what any x86-64 or ARM processor has.
inline constexpr std::size_t LANES = 4;
using Floats = float __attribute__((vector_size(4 * LANES)));
using Integers = std::int32_t __attribute__((vector_size(4 * LANES)));

inline Floats load(const float* from) {
  Floats lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

inline void store(float* to, Floats lanes) { std::memcpy(to, &lanes, sizeof(lanes)); }

inline Floats smaller(Floats a, Floats b) { return a < b ? a : b; }
inline Floats larger(Floats a, Floats b) { return a > b ? a : b; }

}  // namespace coppice
