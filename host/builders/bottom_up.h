#pragma once

#include <span>

#include "builders/bvh.h"

namespace coppice {

// Merges neighbours in the order of the list, level by level: 2i with 2i + 1, a last odd one carried to the
// next level, until one is left. The bottom-up builder of the comparison that this project continues; without
// a search for the closest pair (Walter et al., "Fast Agglomerative Clustering for Rendering", 2008) it is as
// good as the order of the file.
//
// The tree is as low as it can be; `rounds` counts the levels, and each level stands before the one below
// it. Sequential. Triangles with a non-finite coordinate are left out. Throws std::length_error for more than
// 2^31 triangles.
Bvh build_bottom_up(std::span<const Triangle> triangles);

}  // namespace coppice
