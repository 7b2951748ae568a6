#include "builders/sbvh.h"

#include <algorithm>
#include <stdexcept>

#include "builders/clip.h"
#include "builders/leaves.h"
#include "builders/sbvh_bins.h"

namespace coppice {
namespace {

double root_half_area(std::span<const Triangle> triangles) {
  GrowingBox box;
  for (const Triangle& triangle : triangles) {
    if (is_active(triangle)) box.grow(triangle_box(triangle));
  }
  return box.half_area();
}

double overlap_half_area(const GrowingBox& a, const GrowingBox& b) {
  GrowingBox overlap = a;
  overlap.shrink(b);
  return overlap.half_area();
}

GrowingBox united(GrowingBox box, const GrowingBox& other) {
  box.grow(other);
  return box;
}

// Decides for each reference that the plane crosses whether it is split. Costs are those of both children
// with what was decided before.
class Unsplitting {
 public:
  enum class Choice { split, left, right };

  Unsplitting(const SpatialSplit& split, std::uint32_t left_count, std::uint32_t right_count)
      : left_(split.left), right_(split.right), left_count_(left_count), right_count_(right_count) {}

  Choice choose(const GrowingBox& whole) {
    const double left_area = left_.half_area(), right_area = right_.half_area();
    const GrowingBox left_with = united(left_, whole), right_with = united(right_, whole);
    const double split_cost = left_area * left_count_ + right_area * right_count_;
    const double left_cost = left_with.half_area() * left_count_ + right_area * (right_count_ - 1);
    const double right_cost = left_area * (left_count_ - 1) + right_with.half_area() * right_count_;
    // No side is left empty.
    if (right_count_ > 1 && left_cost < split_cost && (left_cost <= right_cost || left_count_ == 1)) {
      left_ = left_with;
      --right_count_;
      return Choice::left;
    }
    if (left_count_ > 1 && right_cost < split_cost) {
      right_ = right_with;
      --left_count_;
      return Choice::right;
    }
    return Choice::split;
  }

 private:
  GrowingBox left_, right_;
  double left_count_, right_count_;
};

class SbvhSplitter : public ReferenceSplitter {
 public:
  SbvhSplitter(std::span<const Triangle> triangles, double overlap_threshold)
      : triangles_(triangles), least_overlap_(overlap_threshold * root_half_area(triangles)) {}

  void split(const ReferenceSet& set, SplitSides& sides) const override {
    const NodeBounds bounds(set.references);
    ObjectSplit object = find_object_split(set.references, bounds);
    const bool coincide = !(object.cost < std::numeric_limits<double>::infinity());
    const double overlap = coincide ? bounds.box.half_area() : overlap_half_area(object.left, object.right);
    if (coincide) object.cost = bounds.box.half_area() * static_cast<double>(set.references.size());
    if (overlap > least_overlap_) {
      const SpatialSplit spatial = find_spatial_split(set.references, triangles_, bounds.box);
      if (spatial.cost < object.cost && split_at(spatial, set, sides)) return;
    }
    if (coincide) return;
    for (const Reference& reference : set.references) {
      object.goes_left(reference) ? sides.push_left(reference) : sides.push_right(reference);
    }
  }

 private:
  // False where the spare references may not suffice.
  bool split_at(const SpatialSplit& plane, const ReferenceSet& set, SplitSides& sides) const {
    std::uint32_t left_count = 0, right_count = 0;
    for (const Reference& reference : set.references) {
      left_count += !plane.is_right(reference);
      right_count += !plane.is_left(reference);
    }
    if (left_count + right_count - set.references.size() > set.spare) {
      sides.cap_reached = true;
      return false;
    }
    Unsplitting unsplitting(plane, left_count, right_count);
    for (const Reference& reference : set.references) {
      if (plane.is_left(reference)) {
        sides.push_left(reference);
      } else if (plane.is_right(reference)) {
        sides.push_right(reference);
      } else {
        push_crossed(plane, reference, unsplitting, sides);
      }
    }
    return true;
  }

  void push_crossed(const SpatialSplit& plane, const Reference& reference, Unsplitting& unsplitting,
                    SplitSides& sides) const {
    const GrowingBox whole{reference.box_min, reference.box_max};
    switch (unsplitting.choose(whole)) {
      case Unsplitting::Choice::left:
        return sides.push_left(reference);
      case Unsplitting::Choice::right:
        return sides.push_right(reference);
      case Unsplitting::Choice::split:
        break;
    }
    const ClippedBoxes parts = clip_at_plane(triangles_[reference.child], whole, plane.axis, plane.plane);
    if (!parts.left.is_empty()) sides.push_left({parts.left.box_min, reference.child, parts.left.box_max, 0});
    if (!parts.right.is_empty()) {
      sides.push_right({parts.right.box_min, reference.child, parts.right.box_max, 0});
    }
    // Its box only comes near the triangle; but none may vanish without need.
    if (parts.left.is_empty() && parts.right.is_empty()) sides.push_left(reference);
  }

  std::span<const Triangle> triangles_;
  double least_overlap_;
};

}  // namespace

Bvh build_sbvh(std::span<const Triangle> triangles, const SbvhConfig& config) {
  if (!(config.overlap_threshold >= 0.0)) throw std::invalid_argument("A negative overlap threshold");
  return build_reference_tree(triangles, config.reference_cap,
                              SbvhSplitter(triangles, config.overlap_threshold), config.threads);
}

}  // namespace coppice
