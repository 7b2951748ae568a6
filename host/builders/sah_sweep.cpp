#include "builders/sah_sweep.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include "builders/lane_box.h"
#include "builders/leaves.h"
#include "builders/subtree.h"

namespace coppice {
namespace {

class Sweep {
 public:
  explicit Sweep(std::vector<Node> leaves)
      : leaves_(std::move(leaves)),
        scale_(centre_scale(bounds_of(leaves_))),
        costs_(leaves_.size()),
        in_second_(leaves_.size()),
        seconds_(leaves_.size()) {
    std::vector<Floats> centres;
    centres.reserve(leaves_.size());
    for (const Node& leaf : leaves_) centres.push_back(scaled_centre(lane_box(leaf), scale_));
    for (std::size_t axis = 0; axis < AXES; ++axis) {
      orders_[axis].resize(leaves_.size());
      std::iota(orders_[axis].begin(), orders_[axis].end(), 0);
      std::sort(orders_[axis].begin(), orders_[axis].end(), [&](std::uint32_t a, std::uint32_t b) {
        return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
      });
    }
  }

  // Puts the leaves of the subtree in order, along each axis and within either part, and returns the index of
  // the first one of the second part.
  std::uint32_t split(const Subtree& subtree) {
    Best best;
    if (subtree.count() > 2 && !must_halve(subtree)) {
      for (std::size_t axis = 0; axis < AXES; ++axis) sweep(subtree, axis, best);
    }
    if (best.cost == NO_COST) best = {0.0f, 0, subtree.begin + subtree.count() / 2};
    const std::vector<std::uint32_t>& order = orders_[best.axis];
    for (std::uint32_t i = subtree.begin; i < subtree.end; ++i) in_second_[order[i]] = i >= best.middle;
    for (std::size_t axis = 0; axis < AXES; ++axis) {
      if (axis != best.axis) partition(subtree, orders_[axis]);
    }
    return best.middle;
  }

  Node leaf(std::uint32_t place) const { return leaves_[orders_[0][place]]; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(leaves_.size()); }

 private:
  static constexpr float NO_COST = std::numeric_limits<float>::infinity();

  struct Best {
    float cost = NO_COST;
    std::size_t axis = 0;
    std::uint32_t middle = 0;
  };

  float centre(std::uint32_t leaf, std::size_t axis) const {
    return scaled_centre(lane_box(leaves_[leaf]), scale_)[axis];
  }

  void sweep(const Subtree& subtree, std::size_t axis, Best& best) {
    const std::vector<std::uint32_t>& order = orders_[axis];
    if (centre(order[subtree.begin], axis) == centre(order[subtree.end - 1], axis)) return;
    LaneBox box = EMPTY_LANE_BOX;
    for (std::uint32_t i = subtree.end - 1; i > subtree.begin; --i) {
      box = lane_union(box, lane_box(leaves_[order[i]]));
      costs_[i] = half_area(box, scale_) * static_cast<float>(subtree.end - i);
    }
    box = EMPTY_LANE_BOX;
    for (std::uint32_t i = subtree.begin + 1; i < subtree.end; ++i) {
      box = lane_union(box, lane_box(leaves_[order[i - 1]]));
      const float cost = half_area(box, scale_) * static_cast<float>(i - subtree.begin) + costs_[i];
      if (cost < best.cost) best = {cost, axis, i};
    }
  }

  // Stable, so that both parts stay sorted.
  void partition(const Subtree& subtree, std::vector<std::uint32_t>& order) {
    std::size_t firsts = subtree.begin, seconds = 0;
    for (std::uint32_t i = subtree.begin; i < subtree.end; ++i) {
      const std::uint32_t leaf = order[i];
      order[firsts] = leaf;
      seconds_[seconds] = leaf;
      firsts += !in_second_[leaf];
      seconds += in_second_[leaf];
    }
    std::copy_n(seconds_.begin(), seconds, order.begin() + static_cast<std::ptrdiff_t>(firsts));
  }

  std::vector<Node> leaves_;
  float scale_;
  std::array<std::vector<std::uint32_t>, AXES> orders_;  // leaves by their centres along each axis
  std::vector<float> costs_;                             // of the second part, by its first place
  std::vector<std::uint8_t> in_second_;                  // by leaf
  std::vector<std::uint32_t> seconds_;
};

}  // namespace

Bvh build_sah_sweep(std::span<const Triangle> triangles) {
  Sweep sweep(make_leaves(triangles));
  Bvh bvh;
  bvh.active_count = sweep.count();
  if (bvh.active_count == 0) return bvh;
  bvh.nodes.resize(2 * std::size_t{bvh.active_count} - 1);
  split_subtree(
      whole_tree(bvh.active_count), [&](std::uint32_t place) { return sweep.leaf(place); }, bvh.nodes,
      [&](const Subtree& subtree) { return sweep.split(subtree); });
  return bvh;
}

}  // namespace coppice
