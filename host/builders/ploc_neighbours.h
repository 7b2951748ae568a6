#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "builders/threads.h"
#include "interface/ploc.h"

namespace coppice {

// The boxes of PLOC's clusters in normalised space, an array for each coordinate so that the search for
// neighbours runs on vectors. Infinite boxes stand on both sides of the clusters: they are nobody's nearest.
class ClusterBoxes {
 public:
  // Clusters searched together, so that their boxes stay in the first-level cache for all gaps.
  static constexpr std::size_t TILE = 256;

  // Boxes yet to be set. `radius` is that of the searches to come, 1 to PLOC_MAX_RADIUS. At most 2^31 - 1
  // boxes.
  ClusterBoxes(std::size_t count, std::uint32_t radius);
  ClusterBoxes(std::span<const Aabb> boxes, std::uint32_t radius);

  void set(std::size_t place, const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
      low(axis)[place] = box.box_min[axis];
      high(axis)[place] = box.box_max[axis];
    }
  }

  // Place `to` takes the box of place `from` of `others`.
  void copy(std::size_t to, const ClusterBoxes& others, std::size_t from) {
    for (int axis = 0; axis < 3; ++axis) {
      low(axis)[to] = others.low(axis)[from];
      high(axis)[to] = others.high(axis)[from];
    }
  }

  // Place `to` takes the union of the boxes of places `a` and `b` of `others`.
  void merge(std::size_t to, const ClusterBoxes& others, std::size_t a, std::size_t b) {
    for (int axis = 0; axis < 3; ++axis) {
      low(axis)[to] = std::min(others.low(axis)[a], others.low(axis)[b]);
      high(axis)[to] = std::max(others.high(axis)[a], others.high(axis)[b]);
    }
  }

  // Only the first `count` clusters are left, of at most as many as there were at first.
  void shrink(std::size_t count);

  // For each cluster i its nearest neighbour, nearest[i] = j != i with |i - j| <= radius. The distance is the
  // half area of the union; of equal distances the least (gap, bit) wins, with gap = |i - j| and bit = the
  // lowest set bit of gap in min(i, j). All of this belongs to the pair and orders the pairs of any cluster
  // strictly, so the least pair of all is mutual, and of coincident boxes all but a last odd one pair up. At
  // least two clusters; `nearest` has room for all.
  void find_nearest(std::span<std::uint32_t> nearest) const { find_nearest({0, count_}, nearest); }
  // The same, of the clusters of `chunk` only, which begins at a multiple of TILE.
  void find_nearest(Chunk chunk, std::span<std::uint32_t> nearest) const;

 private:
  static constexpr float INFINITE_EXTENT = std::numeric_limits<float>::infinity();

  // The least and largest coordinates of the clusters' boxes.
  float* low(int axis) { return first_ + axis * stride_; }
  float* high(int axis) { return first_ + (3 + axis) * stride_; }
  const float* low(int axis) const { return first_ + axis * stride_; }
  const float* high(int axis) const { return first_ + (3 + axis) * stride_; }

  void find_nearest_in_tile(Chunk tile, std::span<std::uint32_t> nearest) const;
  void write_union_areas(std::ptrdiff_t first, std::size_t count, std::size_t gap, float* areas) const;

  std::size_t count_;
  std::size_t radius_;
  std::size_t stride_;  // from the array of one coordinate to that of the next one
  std::unique_ptr<float[]> storage_;
  float* first_;  // the first coordinate of the first cluster, behind infinite boxes
};

}  // namespace coppice
