#include "builders/sah_bins.h"

#include <limits>

namespace coppice {
namespace {

constexpr Floats INFINITE_COST = Floats{} + std::numeric_limits<float>::infinity();

// Half the areas of three boxes, in the lane of their axis. Empty boxes have none.
Floats half_areas(const std::array<LaneBox, AXES>& boxes, float scale) {
  const auto extent = [&](int axis) {
    return larger(boxes[axis].high * scale - boxes[axis].low * scale, Floats{});
  };
  const Floats a = extent(0), b = extent(1), c = extent(2);
  // Transposed: the extents along x of all three boxes, along y, along z.
  const Floats ab_xy = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Floats ab_z = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Floats x = __builtin_shufflevector(ab_xy, c, 0, 1, 4, 7);
  const Floats y = __builtin_shufflevector(ab_xy, c, 2, 3, 5, 7);
  const Floats z = __builtin_shufflevector(ab_z, c, 0, 1, 6, 7);
  return (x * y + y * z) + z * x;
}

Floats as_floats(Integers counts) { return __builtin_convertvector(counts, Floats); }

}  // namespace

BinGrid::BinGrid(const LaneBox& centre_bounds, std::uint32_t bin_count, float scale)
    : low_(centre_bounds.low), scale_(scale), bin_count_(bin_count) {
  // Centres that differ by less than this, of at most 2^40, are as good as one.
  constexpr float least_extent = 0x1p-60f;
  const Floats extent = centre_bounds.high - centre_bounds.low;
  const Integers is_usable = extent > Floats{} + least_extent;
  // A bit less than bin_count, so that the last centre falls into the last bin and not behind it.
  const float bins = static_cast<float>(bin_count) * 0.99999f;
  bins_per_unit_ = is_usable ? bins / (is_usable ? extent : Floats{} + 1.0f) : Floats{};
  is_flat_ = (is_usable[0] | is_usable[1] | is_usable[2]) == 0;
}

Bins::Bins(std::uint32_t bin_count) : bin_count_(bin_count) {
  for (std::uint32_t bin = 0; bin < bin_count; ++bin) {
    boxes_[bin].fill(EMPTY_LANE_BOX);
    counts_[bin] = Integers{};
  }
}

void Bins::add(std::span<const Node> leaves, const BinGrid& grid) {
  for (const Node& leaf : leaves) {
    const LaneBox box = lane_box(leaf);
    const Integers bins = grid.bins_of(box);
    for (std::size_t axis = 0; axis < AXES; ++axis) {
      LaneBox& bounds = boxes_[bins[axis]][axis];
      bounds = lane_union(bounds, box);
    }
    for (std::size_t axis = 0; axis < AXES; ++axis) ++counts_[bins[axis]][axis];
  }
}

void Bins::add(const Bins& other) {
  for (std::uint32_t bin = 0; bin < bin_count_; ++bin) {
    for (std::size_t axis = 0; axis < AXES; ++axis) {
      boxes_[bin][axis] = lane_union(boxes_[bin][axis], other.boxes_[bin][axis]);
    }
    counts_[bin] += other.counts_[bin];
  }
}

std::optional<BinSplit> Bins::best_split(float scale) const {
  std::array<Floats, LIMIT> costs_above;  // of the bins from this one on
  std::array<LaneBox, AXES> bounds;
  bounds.fill(EMPTY_LANE_BOX);
  Integers count = {};
  for (std::uint32_t bin = bin_count_ - 1; bin > 0; --bin) {
    for (std::size_t axis = 0; axis < AXES; ++axis)
      bounds[axis] = lane_union(bounds[axis], boxes_[bin][axis]);
    count += counts_[bin];
    const Floats cost = half_areas(bounds, scale) * as_floats(count);
    costs_above[bin] = count > 0 ? cost : INFINITE_COST;
  }
  Floats least = INFINITE_COST;
  Integers first_bins = {};
  bounds.fill(EMPTY_LANE_BOX);
  count = Integers{};
  for (std::uint32_t bin = 1; bin < bin_count_; ++bin) {
    for (std::size_t axis = 0; axis < AXES; ++axis)
      bounds[axis] = lane_union(bounds[axis], boxes_[bin - 1][axis]);
    count += counts_[bin - 1];
    const Floats cost = half_areas(bounds, scale) * as_floats(count) + costs_above[bin];
    const Integers is_less = (count > 0) & (cost < least);
    least = is_less ? cost : least;
    first_bins = is_less ? Integers{} + static_cast<std::int32_t>(bin) : first_bins;
  }
  int best = 0;
  for (int axis = 1; axis < static_cast<int>(AXES); ++axis) {
    if (least[axis] < least[best]) best = axis;
  }
  if (first_bins[best] == 0) return {};
  return BinSplit{best, first_bins[best]};
}

}  // namespace coppice
