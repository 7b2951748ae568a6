#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"

namespace coppice {

struct SahConfig {
  std::uint32_t threads = 0;  // 0: as many as the machine runs at once
};

// Binned SAH: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007. Each node sorts
// its triangles by the centres of their boxes into bins across the bounds of these centres, along all three
// axes, and splits between the two bins where A(first) * count(first) + A(second) * count(second) is least
// (equation 1 with C_i = C_l = 1, down to single triangles).
//
// Where all centres coincide the list is split in its middle as it stands, and also where the tree would
// become higher than SPLIT_HEIGHT_LIMIT. The tree is a pure function of the triangles, whatever the number of
// threads. Triangles with a non-finite coordinate are left out. Throws std::length_error for more than 2^31
// triangles.
Bvh build_sah(std::span<const Triangle> triangles, const SahConfig& config = {});

}  // namespace coppice
