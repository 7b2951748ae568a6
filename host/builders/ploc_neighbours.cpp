#include "builders/ploc_neighbours.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace coppice {
namespace {

// Vectors of GCC and Clang: every operation is that of a lane, and a comparison gives all bits or none.
// Four lanes are what any x86-64 or ARM processor has.
constexpr std::size_t LANES = 4;
using Floats = float __attribute__((vector_size(4 * LANES)));
using Integers = std::int32_t __attribute__((vector_size(4 * LANES)));

// Clusters searched together, so that their boxes stay in the first-level cache for all gaps.
constexpr std::size_t TILE = 256;
static_assert(TILE % LANES == 0);

constexpr float INFINITE_AREA = std::numeric_limits<float>::infinity();

constexpr std::size_t whole_lanes(std::size_t count) { return (count + LANES - 1) / LANES * LANES; }

Floats load(const float* from) {
  Floats lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

void store(float* to, Floats lanes) { std::memcpy(to, &lanes, sizeof(lanes)); }

Floats smaller(Floats a, Floats b) { return a < b ? a : b; }
Floats larger(Floats a, Floats b) { return a > b ? a : b; }

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

ClusterBoxes::ClusterBoxes(std::span<const Aabb> boxes, std::uint32_t radius)
    : count_(boxes.size()), radius_(radius), front_(whole_lanes(radius)) {
  const std::size_t size = front_ + count_ + radius_ + LANES;
  for (auto* coordinate : {&min_x_, &min_y_, &min_z_}) coordinate->assign(size, -INFINITE_EXTENT);
  for (auto* coordinate : {&max_x_, &max_y_, &max_z_}) coordinate->assign(size, INFINITE_EXTENT);
  for (std::size_t i = 0; i < count_; ++i) {
    min_x_[front_ + i] = boxes[i].box_min.x;
    min_y_[front_ + i] = boxes[i].box_min.y;
    min_z_[front_ + i] = boxes[i].box_min.z;
    max_x_[front_ + i] = boxes[i].box_max.x;
    max_y_[front_ + i] = boxes[i].box_max.y;
    max_z_[front_ + i] = boxes[i].box_max.z;
  }
}

void ClusterBoxes::shrink(std::size_t count) {
  // What stood further behind the clusters than this is infinite already, or out of reach.
  const std::size_t first = front_ + count;
  const std::size_t last = std::min(first + radius_ + LANES, front_ + count_);
  for (auto* coordinate : {&min_x_, &min_y_, &min_z_}) {
    std::fill(coordinate->begin() + first, coordinate->begin() + last, -INFINITE_EXTENT);
  }
  for (auto* coordinate : {&max_x_, &max_y_, &max_z_}) {
    std::fill(coordinate->begin() + first, coordinate->begin() + last, INFINITE_EXTENT);
  }
  count_ = count;
}

// areas[k] = half area of the union of the boxes of clusters first + k and first + k + gap, 0 <= k < count
// and up to LANES - 1 more.
void ClusterBoxes::write_union_areas(std::ptrdiff_t first, std::size_t count, std::size_t gap,
                                     float* areas) const {
  const std::size_t begin = front_ + first;
  for (std::size_t k = 0; k < count; k += LANES) {
    const std::size_t i = begin + k;
    const std::size_t j = i + gap;
    const Floats x = larger(load(&max_x_[i]), load(&max_x_[j])) - smaller(load(&min_x_[i]), load(&min_x_[j]));
    const Floats y = larger(load(&max_y_[i]), load(&max_y_[j])) - smaller(load(&min_y_[i]), load(&min_y_[j]));
    const Floats z = larger(load(&max_z_[i]), load(&max_z_[j])) - smaller(load(&min_z_[i]), load(&min_z_[j]));
    const Floats area = (x * y + y * z) + z * x;
    store(areas + k, area);
  }
}

void ClusterBoxes::find_nearest_in_tile(std::size_t first, std::span<std::uint32_t> nearest) const {
  const std::size_t count = std::min(TILE, count_ - first);
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

void ClusterBoxes::find_nearest(std::span<std::uint32_t> nearest) const {
  for (std::size_t first = 0; first < count_; first += TILE) find_nearest_in_tile(first, nearest);
}

}  // namespace coppice
