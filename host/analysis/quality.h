#pragma once

#include <cstdint>
#include <span>

#include "interface/types.h"

namespace coppice {

struct TreeQuality {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint32_t depth = 0;       // edges on the longest way from the root to a leaf; 0 for a lone leaf
  std::uint64_t references = 0;  // triangles in leaves; more than there are triangles where splits duplicate
  double sah = 0.0;
};

// Measures a valid tree (find_fault names no fault); all zero for an empty one. The SAH cost (MacDonald and
// Booth, "Heuristics for ray tracing using space subdivision", 1990; C_i = C_l = 1) is the sum of
// A(node) / A(root) over the internal nodes and of A(leaf) / A(root) times the leaf's triangles over the
// leaves; the A of a NOTHING_BOX is 0. Where A(root) is 0, on coincident or collinear triangles, every ratio
// counts as 1.
TreeQuality measure_quality(std::span<const Node> nodes);

}  // namespace coppice
