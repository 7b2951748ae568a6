#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"

namespace coppice {

struct LbvhConfig {
  std::uint32_t morton_bits = 30;  // 30 or 60
  std::uint32_t threads = 0;       // 0: as many as the machine runs at once
};

// Linear BVH: the radix tree over Morton codes, built in one pass from the leaves up. Apetrei, "Fast and
// Simple Agglomerative LBVH Construction", 2014, after Karras, "Maximizing Parallelism in the Construction of
// BVHs, Octrees, and k-d Trees", 2012. Equal codes are told apart by their place in the order.
//
// No higher than morton_bits + 31. The tree is a pure function of triangles and morton_bits, whatever the
// number of threads. Triangles with a non-finite coordinate are left out. Throws std::invalid_argument for a
// config out of range and std::length_error for more than 2^31 triangles.
Bvh build_lbvh(std::span<const Triangle> triangles, const LbvhConfig& config = {});

}  // namespace coppice
