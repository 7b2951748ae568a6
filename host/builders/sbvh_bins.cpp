#include "builders/sbvh_bins.h"

#include <algorithm>
#include <array>
#include <utility>

#include "builders/lanes.h"

namespace coppice {
namespace {

double twice_midpoint(const Reference& reference, int axis) {
  return double{reference.box_min[axis]} + reference.box_max[axis];
}

// The box of the references, or their parts, in a bin, and how many references begin and end in it: those
// that begin before a place between bins are on its left, those that end behind it on its right.
struct Bin {
  GrowingBox box;
  std::uint32_t begins = 0;
  std::uint32_t ends = 0;
};

// Small nodes are the many, and there a few bins find the same splits.
std::uint32_t bin_count_for(std::size_t count) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(4 + count / 8, SBVH_MAX_BINS));
}

std::uint32_t bin_of(double offset, double bins_per_length, std::uint32_t bin_count) {
  return std::min(static_cast<std::uint32_t>(offset * bins_per_length), bin_count - 1);
}

struct BinnedSplit {
  double cost = std::numeric_limits<double>::infinity();
  std::uint32_t first_right_bin = 0;
  GrowingBox left, right;
};

// The cheapest place between bins that has something on both sides.
BinnedSplit cheapest_split(std::span<const Bin> bins) {
  std::array<GrowingBox, SBVH_MAX_BINS> right_boxes;
  std::array<std::uint32_t, SBVH_MAX_BINS> right_counts;
  GrowingBox right;
  std::uint32_t right_count = 0;
  for (std::size_t i = bins.size(); i-- > 1;) {
    right.grow(bins[i].box);
    right_count += bins[i].ends;
    right_boxes[i] = right;
    right_counts[i] = right_count;
  }
  BinnedSplit best;
  GrowingBox left;
  std::uint32_t left_count = 0;
  for (std::uint32_t i = 1; i < bins.size(); ++i) {
    left.grow(bins[i - 1].box);
    left_count += bins[i - 1].begins;
    if (left_count == 0 || right_counts[i] == 0) continue;
    const double cost = left.half_area() * left_count + right_boxes[i].half_area() * right_counts[i];
    if (cost < best.cost) best = {cost, i, left, right_boxes[i]};
  }
  return best;
}

Floats lanes_of(const vec3& point) { return Floats{point.x, point.y, point.z, 0.0f}; }
vec3 point_of(Floats lanes) { return {lanes[0], lanes[1], lanes[2]}; }

// The box of a part of a triangle, or of several; empty at first.
struct LanePart {
  Floats box_min = Floats{} + std::numeric_limits<float>::infinity();
  Floats box_max = Floats{} - std::numeric_limits<float>::infinity();

  // A coordinate that is not a number, where an edge is too long for float, is read over.
  void grow(Floats low, Floats high) {
    box_min = smaller(low, box_min);
    box_max = larger(high, box_max);
  }
  void grow(Floats point) { grow(point, point); }
};

// A triangle with its corners in order along an axis.
class ChoppedTriangle {
 public:
  ChoppedTriangle(const Triangle& triangle, int axis)
      : axis_(axis), corners_{lanes_of(triangle.a), lanes_of(triangle.b), lanes_of(triangle.c)} {
    order(0, 1);
    order(1, 2);
    order(0, 1);
    long_edge_ = edge(0, 2);
    short_edges_[0] = edge(0, 1);
    short_edges_[1] = edge(1, 2);
  }

  // The part up to a plane that lies beyond all those before.
  LanePart part_up_to(float plane) {
    LanePart part = cut_;
    add_corners_up_to(plane, part);
    cut_ = {};
    if (next_corner_ > 0 && next_corner_ < 3) {
      cut_.grow(point_on(long_edge_, 0, plane));
      cut_.grow(point_on(short_edges_[next_corner_ - 1], next_corner_ - 1, plane));
    }
    part.grow(cut_.box_min, cut_.box_max);
    return part;
  }

  // What lies beyond the last plane.
  LanePart rest() {
    LanePart part = cut_;
    add_corners_up_to(std::numeric_limits<float>::infinity(), part);
    return part;
  }

 private:
  void order(int a, int b) {
    if (corners_[b][axis_] < corners_[a][axis_]) std::swap(corners_[a], corners_[b]);
  }
  // How the point moves for each unit along the axis.
  Floats edge(int from, int to) const {
    const Floats along = corners_[to] - corners_[from];
    return along / along[axis_];
  }
  Floats point_on(Floats edge, int from, float plane) const {
    Floats point = corners_[from] + edge * (plane - corners_[from][axis_]);
    point[axis_] = plane;
    return point;
  }
  void add_corners_up_to(float plane, LanePart& part) {
    while (next_corner_ < 3 && corners_[next_corner_][axis_] <= plane) part.grow(corners_[next_corner_++]);
  }

  int axis_;
  Floats corners_[3];
  Floats long_edge_, short_edges_[2];
  int next_corner_ = 0;
  LanePart cut_;  // the triangle in the last plane
};

// Chops references along one axis of a node's box. All in float and without care for rounding: parts only
// serve to compare planes, and clip_at_plane makes those that stay.
class SpatialBins {
 public:
  SpatialBins(const GrowingBox& box, int axis, std::uint32_t bin_count)
      : axis_(axis), bin_count_(bin_count), low_(box.box_min[axis]) {
    const double length = box.box_max[axis] - low_;
    bins_per_length_ = bin_count / length;
    for (std::uint32_t i = 0; i < bin_count; ++i)
      planes_[i] = static_cast<float>(low_ + length * i / bin_count);
  }

  void add(const Reference& reference, const Triangle& triangle) {
    const std::uint32_t first = bin_of(reference.box_min[axis_] - low_, bins_per_length_, bin_count_);
    const std::uint32_t last = bin_of(reference.box_max[axis_] - low_, bins_per_length_, bin_count_);
    ++begins_[first];
    ++ends_[last];
    const Floats low = lanes_of(reference.box_min), high = lanes_of(reference.box_max);
    if (first == last) return parts_[first].grow(low, high);
    ChoppedTriangle chopped(triangle, axis_);
    for (std::uint32_t i = first; i <= last; ++i) {
      const LanePart part = i < last ? chopped.part_up_to(planes_[i + 1]) : chopped.rest();
      parts_[i].grow(larger(part.box_min, low), smaller(part.box_max, high));
    }
  }

  SpatialSplit split() const {
    std::array<Bin, SBVH_MAX_BINS> bins;
    for (std::uint32_t i = 0; i < bin_count_; ++i) {
      bins[i] = {{point_of(parts_[i].box_min), point_of(parts_[i].box_max)}, begins_[i], ends_[i]};
    }
    const BinnedSplit best = cheapest_split(std::span(bins).first(bin_count_));
    return {best.cost, axis_, planes_[best.first_right_bin], best.left, best.right};
  }

 private:
  int axis_;
  std::uint32_t bin_count_;
  double low_, bins_per_length_;
  std::array<float, SBVH_MAX_BINS> planes_;  // where each bin begins
  std::array<LanePart, SBVH_MAX_BINS> parts_;
  std::array<std::uint32_t, SBVH_MAX_BINS> begins_{}, ends_{};
};

}  // namespace

NodeBounds::NodeBounds(std::span<const Reference> references) {
  for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = twice_midpoint(references[0], axis);
  for (const Reference& reference : references) {
    box.grow(reference);
    for (int axis = 0; axis < 3; ++axis) {
      const double midpoint = twice_midpoint(reference, axis);
      low[axis] = midpoint < low[axis] ? midpoint : low[axis];
      high[axis] = midpoint > high[axis] ? midpoint : high[axis];
    }
  }
}

bool ObjectSplit::goes_left(const Reference& reference) const {
  return bin_of(twice_midpoint(reference, axis) - low, bins_per_length, bin_count) < first_right_bin;
}

ObjectSplit find_object_split(std::span<const Reference> references, const NodeBounds& bounds) {
  const std::uint32_t bin_count = bin_count_for(references.size());
  std::array<std::array<Bin, SBVH_MAX_BINS>, 3> bins;
  double bins_per_length[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double length = bounds.high[axis] - bounds.low[axis];
    bins_per_length[axis] = length > 0.0 ? bin_count / length : 0.0;
  }
  for (const Reference& reference : references) {
    for (int axis = 0; axis < 3; ++axis) {
      const double offset = twice_midpoint(reference, axis) - bounds.low[axis];
      Bin& bin = bins[axis][bin_of(offset, bins_per_length[axis], bin_count)];
      bin.box.grow(reference);
      ++bin.begins;
      ++bin.ends;
    }
  }
  ObjectSplit split;
  for (int axis = 0; axis < 3; ++axis) {
    const BinnedSplit best = cheapest_split(std::span(bins[axis]).first(bin_count));
    if (best.cost < split.cost) {
      split = {best.cost, axis,      best.first_right_bin, bounds.low[axis], bins_per_length[axis], bin_count,
               best.left, best.right};
    }
  }
  return split;
}

SpatialSplit find_spatial_split(std::span<const Reference> references, std::span<const Triangle> triangles,
                                const GrowingBox& box) {
  const std::uint32_t bin_count = bin_count_for(references.size());
  SpatialSplit split;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.box_min[axis] < box.box_max[axis])) continue;
    SpatialBins bins(box, axis, bin_count);
    for (const Reference& reference : references) bins.add(reference, triangles[reference.child]);
    const SpatialSplit best = bins.split();
    if (best.cost < split.cost) split = best;
  }
  return split;
}

}  // namespace coppice
