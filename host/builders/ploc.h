#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"
#include "interface/ploc.h"

namespace coppice {

struct PlocConfig {
  std::uint32_t radius = 16;       // neighbours looked at on each side, 1 to PLOC_MAX_RADIUS
  std::uint32_t morton_bits = 30;  // 30 or 60
};

// PLOC, sequential: Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
// Construction", 2018. Clusters in Morton order merge with their nearest neighbour within the radius where
// the choice is mutual, round by round, until one is left. The tree is a pure function of triangles and
// config, and the same bit for bit as that of the device; docs/numerics.md states the rules.
//
// Triangles with a non-finite coordinate are left out; no other coordinate is denormal or -0. `rounds` is 0
// for fewer than two active triangles. Throws std::invalid_argument for a config out of range and
// std::length_error for more than 2^31 triangles.
Bvh build_ploc(std::span<const Triangle> triangles, const PlocConfig& config = {});

}  // namespace coppice
