#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"
#include "builders/reference_tree.h"

namespace coppice {

struct SbvhConfig {
  ReferenceCap reference_cap = {};
  // Spatial splits are tried where the children of the object split overlap by more than this part of the
  // root's surface area. 1e-5 in the paper; 0 tries them wherever there is any overlap, 1 nowhere.
  double overlap_threshold = 1e-5;
  std::uint32_t threads = 0;  // 0: as many as the machine runs at once
};

// SBVH: Stich, Friedrich and Dietrich, "Spatial splits in bounding volume hierarchies", High Performance
// Graphics 2009. Each node is split by the cheaper, A(left) N_left + A(right) N_right, of
// - a binned object split: midpoints of references in bins across their bounds, on all three axes;
// - where the children of that one overlap by more than the threshold, a binned spatial split: references
//   chopped by planes across the node's box, on all three axes. A reference that the best plane crosses
//   stands on both sides, unless it is cheaper to leave it whole on one of them (reference unsplitting).
// Leaves hold one reference each. Of two references each becomes a leaf: the cost above leaves out the node
// that a third one adds, and so splits pairs that it had better not. Where all midpoints coincide and no
// spatial split is cheaper, the first half of the references, in their order, goes left.
//
// Then tree rotations (reference_tree_rotations.h) rearrange the subtrees of at most 2^14 references.
//
// Triangles are not split where the subtree has fewer spare references left than the plane crosses
// (ReferenceCap); `reference_cap_reached` tells that such a split would have been cheaper. A subtree without
// any gets object splits only.
//
// The tree is a pure function of triangles and config, whatever the number of threads. Throws
// std::invalid_argument for a config out of range, std::length_error for more than 2^31 - 1 triangles.
Bvh build_sbvh(std::span<const Triangle> triangles, const SbvhConfig& config = {});

}  // namespace coppice
