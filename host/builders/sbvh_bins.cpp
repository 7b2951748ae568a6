#include "builders/sbvh_bins.h"

#include <algorithm>
#include <array>
#include <vector>

#include "builders/threads.h"

namespace coppice {
namespace {

// Small nodes are the many, and there a few bins find the same splits.
std::uint32_t object_bin_count(std::size_t count) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(4 + count / 8, Bins::LIMIT));
}
constexpr std::uint32_t SPATIAL_BIN_LIMIT = 16;
std::uint32_t spatial_bin_count(std::size_t count) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(4 + count / 16, SPATIAL_BIN_LIMIT));
}

constexpr std::size_t SBVH_CHUNK = 1 << 12;

// Grows `sum`, that of no references, by those of the node with add(sum, references). Chunk by chunk where
// the node is split together: sums must not depend on the order of their parts.
template <class Sum, class Add>
void sum_up(const ReferenceSet& set, Sum& sum, const Add& add) {
  if (!set.together) return add(sum, set.references);
  std::vector<Sum> sums(chunk_count(set.references.size(), SBVH_CHUNK), sum);
  set.together->for_each_chunk(set.references.size(), SBVH_CHUNK, [&](Chunk chunk, std::size_t k) {
    add(sums[k], set.references.subspan(chunk.begin, chunk.count()));
  });
  for (const Sum& part : sums) sum.add(part);
}

struct Bounds {
  LaneBox box = EMPTY_LANE_BOX;
  void add(const Bounds& other) { box = lane_union(box, other.box); }
};

LaneBox centre_bounds(const ReferenceSet& set, float scale) {
  const auto add = [&](Bounds& bounds, std::span<const Reference> references) {
    for (const Reference& reference : references) {
      const Floats centre = scaled_centre(lane_box(reference), scale);
      bounds.box = lane_union(bounds.box, {centre, centre});
    }
  };
  Bounds bounds;
  sum_up(set, bounds, add);
  return bounds.box;
}

// Left and right child.
struct Children {
  std::array<LaneBox, 2> boxes = {EMPTY_LANE_BOX, EMPTY_LANE_BOX};
  std::array<std::uint32_t, 2> counts = {};

  void add(const Children& other) {
    for (int side = 0; side < 2; ++side) {
      boxes[side] = lane_union(boxes[side], other.boxes[side]);
      counts[side] += other.counts[side];
    }
  }
};

Floats lanes_of(const vec3& point) { return Floats{point.x, point.y, point.z, 0.0f}; }
Floats splat(float value) { return Floats{} + value; }

// A triangle's edges, and where they run along one axis: an edge in each lane.
class ChoppedTriangle {
 public:
  explicit ChoppedTriangle(const Triangle& triangle)
      : corners_{lanes_of(triangle.a), lanes_of(triangle.b), lanes_of(triangle.c)},
        edges_{corners_[1] - corners_[0], corners_[2] - corners_[1], corners_[0] - corners_[2]} {}

  const std::array<Floats, 3>& corners() const { return corners_; }

  void look_along(int axis) {
    axis_ = axis;
    from_ = Floats{corners_[0][axis], corners_[1][axis], corners_[2][axis], 0.0f};
    to_ = __builtin_shufflevector(from_, from_, 1, 2, 0, 3);
    per_length_ = 1.0f / (to_ - from_);
  }

  // The box of the triangle in a plane; empty where no edge crosses it.
  LaneBox cut(float plane) const {
    const Floats along = (plane - from_) * per_length_;
    const Integers crosses = (from_ < plane) ^ (to_ < plane);
    LaneBox box = EMPTY_LANE_BOX;
    for (int edge = 0; edge < 3; ++edge) {
      // A coordinate that is not a number, where an edge is too long for float, is read over.
      const Floats point = corners_[edge] + edges_[edge] * splat(along[edge]);
      const Integers is_cut = Integers{} + crosses[edge];
      box.low = smaller(is_cut ? point : EMPTY_LANE_BOX.low, box.low);
      box.high = larger(is_cut ? point : EMPTY_LANE_BOX.high, box.high);
    }
    box.low[axis_] = box.high[axis_] = plane;
    return box;
  }

 private:
  std::array<Floats, 3> corners_, edges_;
  int axis_ = 0;
  Floats from_ = {}, to_ = {}, per_length_ = {};
};

// Chops references along all axes of a node's box. All in float and without care for rounding: parts only
// serve to compare planes, and clip_at_plane makes those that stay.
class SpatialBins {
 public:
  SpatialBins(const LaneBox& box, std::uint32_t bin_count)
      : bin_count_(bin_count), low_(box.low), bin_lengths_((box.high - box.low) / splat(bin_count)) {
    const Floats per_length = 1.0f / bin_lengths_;
    const Integers is_usable = (per_length > 0.0f) & (per_length < splat(std::numeric_limits<float>::max()));
    bins_per_length_ = is_usable ? per_length : Floats{};
    for (std::uint32_t bin = 0; bin < bin_count; ++bin) {
      boxes_[bin].fill(EMPTY_LANE_BOX);
      begins_[bin] = ends_[bin] = Integers{};
    }
  }

  void add(std::span<const Reference> references, std::span<const Triangle> triangles) {
    for (const Reference& reference : references) add(reference, triangles);
  }

  void add(const SpatialBins& other) {
    for (std::uint32_t bin = 0; bin < bin_count_; ++bin) {
      for (std::size_t axis = 0; axis < AXES; ++axis) grow(bin, axis, other.boxes_[bin][axis]);
      begins_[bin] += other.begins_[bin];
      ends_[bin] += other.ends_[bin];
    }
  }

  SpatialSplit cheapest_split(float scale) const {
    SpatialSplit best;
    for (int axis = 0; axis < static_cast<int>(AXES); ++axis) {
      if (bins_per_length_[axis] > 0.0f) sweep(axis, scale, best);
    }
    return best;
  }

 private:
  void add(const Reference& reference, std::span<const Triangle> triangles) {
    const LaneBox box = lane_box(reference);
    const Integers first = bins_of(box.low), last = bins_of(box.high);
    for (int axis = 0; axis < static_cast<int>(AXES); ++axis) {
      ++begins_[first[axis]][axis];
      ++ends_[last[axis]][axis];
      if (first[axis] == last[axis]) grow(first[axis], axis, box);
    }
    const Integers is_chopped = first != last;
    if ((is_chopped[0] | is_chopped[1] | is_chopped[2]) == 0) return;
    ChoppedTriangle triangle(triangles[reference.child]);
    std::array<Floats, 3> points;
    std::array<Integers, 3> bins;
    for (int i = 0; i < 3; ++i) {
      points[i] = smaller(larger(triangle.corners()[i], box.low), box.high);
      bins[i] = bins_of(points[i]);
    }
    for (int axis = 0; axis < static_cast<int>(AXES); ++axis) {
      if (!is_chopped[axis]) continue;
      // The part in a bin is the hull of the corners in it and of the cuts at its ends.
      for (int i = 0; i < 3; ++i) grow(bins[i][axis], axis, {points[i], points[i]});
      triangle.look_along(axis);
      for (int bin = first[axis] + 1; bin <= last[axis]; ++bin) {
        LaneBox cut = triangle.cut(plane_before(bin, axis));
        cut = {larger(cut.low, box.low), smaller(cut.high, box.high)};
        grow(bin - 1, axis, cut);
        grow(bin, axis, cut);
      }
    }
  }

  void sweep(int axis, float scale, SpatialSplit& best) const {
    std::array<LaneBox, SPATIAL_BIN_LIMIT> right_boxes;
    std::array<float, SPATIAL_BIN_LIMIT> right_costs;
    LaneBox box = EMPTY_LANE_BOX;
    std::int32_t count = 0;
    for (std::uint32_t bin = bin_count_; bin-- > 1;) {
      box = lane_union(box, boxes_[bin][axis]);
      count += ends_[bin][axis];
      right_boxes[bin] = box;
      right_costs[bin] = count > 0 ? half_area(box, scale) * static_cast<float>(count)
                                   : std::numeric_limits<float>::infinity();
    }
    box = EMPTY_LANE_BOX;
    count = 0;
    for (std::uint32_t bin = 1; bin < bin_count_; ++bin) {
      box = lane_union(box, boxes_[bin - 1][axis]);
      count += begins_[bin - 1][axis];
      if (count == 0) continue;
      // Infinite, or not a number, for an empty box.
      const float cost = half_area(box, scale) * static_cast<float>(count) + right_costs[bin];
      if (cost < best.cost) {
        best = {cost, axis, plane_before(static_cast<int>(bin), axis), box, right_boxes[bin]};
      }
    }
  }

  Integers bins_of(Floats point) const {
    // Not a number only where lengths overflow: that comes to the last bin.
    const Floats bins = smaller((point - low_) * bins_per_length_, splat(bin_count_ - 1));
    return __builtin_convertvector(bins, Integers);
  }
  float plane_before(int bin, int axis) const {
    return low_[axis] + bin_lengths_[axis] * static_cast<float>(bin);
  }
  void grow(std::uint32_t bin, std::size_t axis, const LaneBox& box) {
    boxes_[bin][axis] = lane_union(boxes_[bin][axis], box);
  }

  std::uint32_t bin_count_;
  Floats low_, bin_lengths_;
  Floats bins_per_length_;  // 0 along axes on which the box is flat, or too long
  std::array<std::array<LaneBox, AXES>, SPATIAL_BIN_LIMIT> boxes_;
  std::array<Integers, SPATIAL_BIN_LIMIT> begins_, ends_;  // how many references, an axis in each lane
};

}  // namespace

LaneBox box_of(const ReferenceSet& set) {
  const auto add = [](Bounds& bounds, std::span<const Reference> references) {
    for (const Reference& reference : references) bounds.box = lane_union(bounds.box, lane_box(reference));
  };
  Bounds bounds;
  sum_up(set, bounds, add);
  return bounds.box;
}

std::optional<ObjectSplit> find_object_split(const ReferenceSet& set, float scale) {
  const BinGrid grid(centre_bounds(set, scale), object_bin_count(set.references.size()), scale);
  if (grid.is_flat()) return {};
  const auto add = [&](Bins& bins, std::span<const Reference> references) { bins.add(references, grid); };
  Bins bins(grid.bin_count());
  sum_up(set, bins, add);
  const std::optional<BinSplit> place = bins.best_split(scale);
  if (!place) return {};
  const auto add_to_side = [&](Children& children, std::span<const Reference> references) {
    for (const Reference& reference : references) {
      const LaneBox box = lane_box(reference);
      const bool side = grid.bins_of(box)[place->axis] >= place->first_bin;
      children.boxes[side] = lane_union(children.boxes[side], box);
      ++children.counts[side];
    }
  };
  Children children;
  sum_up(set, children, add_to_side);
  const auto& [left, right] = children.boxes;
  const float cost = half_area(left, scale) * static_cast<float>(children.counts[0]) +
                     half_area(right, scale) * static_cast<float>(children.counts[1]);
  return ObjectSplit{grid, *place, cost, left, right};
}

SpatialSplit find_spatial_split(const ReferenceSet& set, std::span<const Triangle> triangles,
                                const LaneBox& box, float scale) {
  const auto add = [&](SpatialBins& bins, std::span<const Reference> references) {
    bins.add(references, triangles);
  };
  SpatialBins bins(box, spatial_bin_count(set.references.size()));
  sum_up(set, bins, add);
  return bins.cheapest_split(scale);
}

}  // namespace coppice
