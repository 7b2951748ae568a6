#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "interface/ploc.h"

namespace coppice {

// The boxes of PLOC's clusters in normalised space, an array for each coordinate so that the search for
// neighbours runs on vectors. Infinite boxes stand on both sides of the clusters: they are nobody's nearest.
class ClusterBoxes {
 public:
  // `radius` is that of the searches to come, 1 to PLOC_MAX_RADIUS. At most 2^31 - 1 boxes.
  ClusterBoxes(std::span<const Aabb> boxes, std::uint32_t radius);

  // Place `to` takes the box of place `from`.
  void move(std::size_t to, std::size_t from) {
    for (auto* coordinate : {&min_x_, &min_y_, &min_z_, &max_x_, &max_y_, &max_z_}) {
      (*coordinate)[front_ + to] = (*coordinate)[front_ + from];
    }
  }

  // Place `to` takes the union of the boxes of places `a` and `b`.
  void merge(std::size_t to, std::size_t a, std::size_t b) {
    for (auto* coordinate : {&min_x_, &min_y_, &min_z_}) {
      (*coordinate)[front_ + to] = std::min((*coordinate)[front_ + a], (*coordinate)[front_ + b]);
    }
    for (auto* coordinate : {&max_x_, &max_y_, &max_z_}) {
      (*coordinate)[front_ + to] = std::max((*coordinate)[front_ + a], (*coordinate)[front_ + b]);
    }
  }

  // Only the first `count` clusters are left.
  void shrink(std::size_t count);

  // For each cluster i its nearest neighbour, nearest[i] = j != i with |i - j| <= radius. The distance is the
  // half area of the union; of equal distances the least (gap, bit) wins, with gap = |i - j| and bit = the
  // lowest set bit of gap in min(i, j). All of this belongs to the pair and orders the pairs of any cluster
  // strictly, so the least pair of all is mutual, and of coincident boxes all but a last odd one pair up. At
  // least two clusters; `nearest` has room for all.
  void find_nearest(std::span<std::uint32_t> nearest) const;

 private:
  static constexpr float INFINITE_EXTENT = std::numeric_limits<float>::infinity();

  void find_nearest_in_tile(std::size_t first, std::span<std::uint32_t> nearest) const;
  void write_union_areas(std::ptrdiff_t first, std::size_t count, std::size_t gap, float* areas) const;

  std::size_t count_;
  std::size_t radius_;
  std::size_t front_;  // infinite boxes before the first cluster
  // Indexed by front_ + cluster.
  std::vector<float> min_x_, min_y_, min_z_, max_x_, max_y_, max_z_;
};

}  // namespace coppice
