#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"

namespace coppice {

struct HplocConfig {
  std::uint32_t radius = 8;        // neighbours looked at on each side, 1 to PLOC_MAX_RADIUS
  std::uint32_t morton_bits = 30;  // 30 or 60
};

// H-PLOC: Benthin et al., "H-PLOC: Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume
// Hierarchy Construction", 2024. Each node of the radix tree over the Morton codes leaves at most 16 clusters
// to its parent, the root one: the clusters of its children merge with their nearest neighbours within the
// radius where the choice is mutual, round by round, until no more are left. A node whose parent lies within
// one tile of HPLOC_TILE places leaves all its leaves. The tree is a pure function of triangles and config,
// and the same bit for bit as that of the device; docs/numerics.md states the rules.
//
// Sequential, from the root down. No higher than HPLOC_MAX_HEIGHT. Triangles with a non-finite coordinate are
// left out. Throws std::invalid_argument for a config out of range and std::length_error for more than 2^31
// triangles.
Bvh build_hploc(std::span<const Triangle> triangles, const HplocConfig& config = {});

}  // namespace coppice
