#pragma once

#include <cstdint>
#include <vector>

#include "interface/types.h"

namespace coppice {

// What every builder returns: a binary tree with one triangle a leaf.
struct Bvh {
  std::vector<Node> nodes;         // root at 0, siblings adjacent; empty when no triangle is active
  std::uint32_t active_count = 0;  // triangles in the tree
  std::uint32_t rounds = 0;        // 0 where the builder has none
  // Only builders that split triangles set these two.
  std::uint64_t references = 0;        // leaves; more than active_count where triangles were split
  bool reference_cap_reached = false;  // a cheaper spatial split was given up for want of references
};

}  // namespace coppice
