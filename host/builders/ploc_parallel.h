#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"

namespace coppice {

struct PlocParallelConfig {
  std::uint32_t radius = 16;       // as in PlocConfig
  std::uint32_t morton_bits = 30;  // as in PlocConfig
  std::uint32_t threads = 0;       // 0: as many as the machine runs at once
};

// PLOC (see ploc.h) with oneTBB: leaves, codes, sort, the search for neighbours and the merges of a round in
// chunks, the places of what a chunk writes by prefix sums over the chunks. The same tree as that of
// build_ploc, bit for bit, for every number of threads. Throws as build_ploc does.
Bvh build_ploc_parallel(std::span<const Triangle> triangles, const PlocParallelConfig& config = {});

}  // namespace coppice
