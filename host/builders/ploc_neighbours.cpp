#include "builders/ploc_neighbours.h"

#include <algorithm>
#include <array>
#include <limits>

#include "builders/lanes.h"

namespace coppice {
namespace {

constexpr std::size_t TILE = ClusterBoxes::TILE;
static_assert(TILE % LANES == 0);

constexpr float INFINITE_AREA = std::numeric_limits<float>::infinity();

constexpr std::size_t whole_lanes(std::size_t count) { return (count + LANES - 1) / LANES * LANES; }

// The best neighbours so far of LANES clusters that follow each other.
struct Nearest {
  Floats areas = Floats{} + INFINITE_AREA;
  Integers offsets = {};  // from the cluster to its neighbour
};

// Offers the clusters from `first` on their neighbours at distance `gap` on both sides. Gaps come in
// ascending order, so a tie with an earlier gap changes nothing.
void offer_neighbours(Nearest& best, std::size_t first, std::size_t gap, Floats left, Floats right) {
  const auto signed_gap = static_cast<std::int32_t>(gap);
  const auto bit = static_cast<std::int32_t>(gap & ~(gap - 1));
  const Integers index = static_cast<std::int32_t>(first) + Integers{0, 1, 2, 3};
  // The pair on the left has min(i, j) = i - gap, the one on the right has i; they differ in the lowest bit
  // of the gap, and on a tie the one without it wins.
  const Integers tie_goes_right = (index & bit) == 0;
  const Integers takes_right = (right < left) | ((right == left) & tie_goes_right);
  const Floats areas = smaller(left, right);
  const Integers offsets = takes_right ? Integers{} + signed_gap : Integers{} - signed_gap;
  best.offsets = areas < best.areas ? offsets : best.offsets;
  best.areas = smaller(areas, best.areas);
}

}  // namespace

ClusterBoxes::ClusterBoxes(std::size_t count, std::uint32_t radius) : radius_(radius) {
  const std::size_t front = whole_lanes(radius);
  // Places of the six arrays that are used together must not fall into one set of the cache.
  constexpr std::size_t page = 1024, stagger = 80;
  stride_ = (front + count + radius + LANES + page - 1) / page * page + stagger;
  storage_ = std::make_unique_for_overwrite<float[]>(6 * stride_);
  first_ = storage_.get() + front;
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(low(axis) - front, front, -INFINITE_EXTENT);
    std::fill_n(high(axis) - front, front, INFINITE_EXTENT);
  }
  shrink(count);
}

ClusterBoxes::ClusterBoxes(std::span<const Aabb> boxes, std::uint32_t radius)
    : ClusterBoxes(boxes.size(), radius) {
  for (std::size_t i = 0; i < boxes.size(); ++i) set(i, boxes[i]);
}

void ClusterBoxes::shrink(std::size_t count) {
  // What stands further behind the clusters than this is out of reach.
  const std::size_t reach = radius_ + LANES;
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(low(axis) + count, reach, -INFINITE_EXTENT);
    std::fill_n(high(axis) + count, reach, INFINITE_EXTENT);
  }
  count_ = count;
}

// areas[k] = half area of the union of the boxes of clusters first + k and first + k + gap, 0 <= k < count
// and up to LANES - 1 more.
void ClusterBoxes::write_union_areas(std::ptrdiff_t first, std::size_t count, std::size_t gap,
                                     float* areas) const {
  const auto extent = [&](int axis, std::ptrdiff_t i, std::ptrdiff_t j) {
    return larger(load(high(axis) + i), load(high(axis) + j)) -
           smaller(load(low(axis) + i), load(low(axis) + j));
  };
  for (std::size_t k = 0; k < count; k += LANES) {
    const std::ptrdiff_t i = first + static_cast<std::ptrdiff_t>(k);
    const std::ptrdiff_t j = i + static_cast<std::ptrdiff_t>(gap);
    const Floats x = extent(0, i, j);
    const Floats y = extent(1, i, j);
    const Floats z = extent(2, i, j);
    const Floats area = (x * y + y * z) + z * x;
    store(areas + k, area);
  }
}

void ClusterBoxes::find_nearest_in_tile(Chunk tile, std::span<std::uint32_t> nearest) const {
  const std::size_t first = tile.begin;
  const std::size_t count = tile.count();
  std::array<Nearest, TILE / LANES> best;
  best.fill({});
  // Distances are symmetric: that of clusters i and i + gap, computed once, is offered to both. The areas
  // start `gap` clusters before the tile, where its first clusters have their left neighbours.
  std::array<float, TILE + whole_lanes(PLOC_MAX_RADIUS)> areas;
  for (std::size_t gap = 1; gap <= radius_; ++gap) {
    write_union_areas(static_cast<std::ptrdiff_t>(first) - static_cast<std::ptrdiff_t>(gap), count + gap, gap,
                      areas.data());
    for (std::size_t k = 0; k < count; k += LANES) {
      offer_neighbours(best[k / LANES], first + k, gap, load(&areas[k]), load(&areas[k + gap]));
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::int32_t offset = best[k / LANES].offsets[k % LANES];
    nearest[first + k] = static_cast<std::uint32_t>(first + k) + static_cast<std::uint32_t>(offset);
  }
}

void ClusterBoxes::find_nearest(Chunk chunk, std::span<std::uint32_t> nearest) const {
  for (std::size_t first = chunk.begin; first < chunk.end; first += TILE) {
    find_nearest_in_tile({first, std::min(first + TILE, chunk.end)}, nearest);
  }
}

}  // namespace coppice
