#pragma once

#include <array>

#include "interface/types.h"

namespace coppice::twins {

// What a tile's lookback words hold in the end: the inclusive prefixes of its sums, flagged by the top bit.
template <std::size_t Sums>
void leave_inclusive_prefix(CoherentUintBuffer tile_status, std::size_t tile,
                            const std::array<uint, Sums>& prefix) {
  for (std::size_t sum = 0; sum < Sums; ++sum) tile_status[tile * Sums + sum] = 0x80000000u | prefix[sum];
}

}  // namespace coppice::twins
