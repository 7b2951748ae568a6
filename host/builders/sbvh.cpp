#include "builders/sbvh.h"

#include <atomic>
#include <optional>
#include <stdexcept>

#include "builders/clip.h"
#include "builders/leaves.h"
#include "builders/sbvh_bins.h"

namespace coppice {
namespace {

// Later passes gain less than half a percent each.
constexpr std::uint32_t ROTATION_PASSES = 3;

Aabb active_bounds(std::span<const Triangle> triangles) {
  LaneBox bounds = EMPTY_LANE_BOX;
  for (const Triangle& triangle : triangles) {
    if (!is_active(triangle)) continue;
    const Aabb box = triangle_box(triangle);
    bounds = lane_union(bounds, lane_box({box.box_min, 0, box.box_max, 0}));
  }
  return {{bounds.low[0], bounds.low[1], bounds.low[2]}, {bounds.high[0], bounds.high[1], bounds.high[2]}};
}

// Half of the area that two boxes have in common.
float overlap_half_area(const LaneBox& a, const LaneBox& b, float scale) {
  const LaneBox overlap = {larger(a.low, b.low), smaller(a.high, b.high)};
  const Integers is_apart = overlap.low > overlap.high;
  return is_apart[0] | is_apart[1] | is_apart[2] ? 0.0f : half_area(overlap, scale);
}

// Decides for each reference that the plane crosses whether it is split. Costs are those of both children
// with what was decided before.
class Unsplitting {
 public:
  enum class Choice { split, left, right };

  Unsplitting(const SpatialSplit& split, float scale, std::uint32_t left_count, std::uint32_t right_count)
      : left_(split.left),
        right_(split.right),
        scale_(scale),
        left_count_(static_cast<float>(left_count)),
        right_count_(static_cast<float>(right_count)) {}

  Choice choose(const LaneBox& whole) {
    const float left_area = half_area(left_, scale_), right_area = half_area(right_, scale_);
    const LaneBox left_with = lane_union(left_, whole), right_with = lane_union(right_, whole);
    const float split_cost = left_area * left_count_ + right_area * right_count_;
    const float left_cost = half_area(left_with, scale_) * left_count_ + right_area * (right_count_ - 1);
    const float right_cost = left_area * (left_count_ - 1) + half_area(right_with, scale_) * right_count_;
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
  LaneBox left_, right_;
  float scale_, left_count_, right_count_;
};

class SbvhSplitter : public ReferenceSplitter {
 public:
  SbvhSplitter(std::span<const Triangle> triangles, const Aabb& root, double overlap_threshold)
      : triangles_(triangles),
        scale_(centre_scale(root)),
        least_overlap_(overlap_threshold * half_area(lane_box({root.box_min, 0, root.box_max, 0}), scale_)) {}

  void split(const ReferenceSet& set, SplitSides& sides) const override {
    if (set.references.size() < LEAST_TO_SEARCH) return;
    const std::optional<ObjectSplit> object = find_object_split(set, scale_);
    // Without spare references the search would only tell that the cap was reached, and once is enough.
    if ((set.spare > 0 || !cap_reached_) && split_in_space(set, object, sides)) return;
    if (!object) return;
    for (const Reference& reference : set.references) {
      object->goes_left(reference) ? sides.push_left(reference) : sides.push_right(reference);
    }
  }

 private:
  // Two references become leaves: to split one of them never pays.
  static constexpr std::size_t LEAST_TO_SEARCH = 3;

  // False where the object split, if there is one, is as good or there are too few spare references.
  bool split_in_space(const ReferenceSet& set, const std::optional<ObjectSplit>& object,
                      SplitSides& sides) const {
    const LaneBox box = object ? lane_union(object->left, object->right) : box_of(set);
    const LaneBox &left = object ? object->left : box, &right = object ? object->right : box;
    if (!(overlap_half_area(left, right, scale_) > least_overlap_)) return false;
    const float cost =
        object ? object->cost : half_area(box, scale_) * static_cast<float>(set.references.size());
    const SpatialSplit plane = find_spatial_split(set, triangles_, box, scale_);
    return plane.cost < cost && split_at(plane, set, sides);
  }

  // False where the spare references may not suffice.
  bool split_at(const SpatialSplit& plane, const ReferenceSet& set, SplitSides& sides) const {
    std::uint32_t left_count = 0, right_count = 0;
    for (const Reference& reference : set.references) {
      left_count += !plane.is_right(reference);
      right_count += !plane.is_left(reference);
    }
    if (left_count + right_count - set.references.size() > set.spare) {
      cap_reached_ = sides.cap_reached = true;
      return false;
    }
    Unsplitting unsplitting(plane, scale_, left_count, right_count);
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
    switch (unsplitting.choose(lane_box(reference))) {
      case Unsplitting::Choice::left:
        return sides.push_left(reference);
      case Unsplitting::Choice::right:
        return sides.push_right(reference);
      case Unsplitting::Choice::split:
        break;
    }
    const ClippedBoxes parts = clip_at_plane(triangles_[reference.child],
                                             {reference.box_min, reference.box_max}, plane.axis, plane.plane);
    if (!parts.left.is_empty()) sides.push_left({parts.left.box_min, reference.child, parts.left.box_max, 0});
    if (!parts.right.is_empty()) {
      sides.push_right({parts.right.box_min, reference.child, parts.right.box_max, 0});
    }
    // Its box only comes near the triangle; but none may vanish without need.
    if (parts.left.is_empty() && parts.right.is_empty()) sides.push_left(reference);
  }

  std::span<const Triangle> triangles_;
  float scale_;
  double least_overlap_;
  mutable std::atomic<bool> cap_reached_ = false;
};

}  // namespace

Bvh build_sbvh(std::span<const Triangle> triangles, const SbvhConfig& config) {
  if (!(config.overlap_threshold >= 0.0)) throw std::invalid_argument("A negative overlap threshold");
  const Aabb root = active_bounds(triangles);
  return build_reference_tree(triangles, config.reference_cap,
                              SbvhSplitter(triangles, root, config.overlap_threshold), config.threads,
                              ROTATION_PASSES);
}

}  // namespace coppice
