#include "builders/gd16.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <vector>

#include "builders/clip.h"

namespace coppice {
namespace {

// Twice the midpoint of the box. In double: never beyond the range, nor outside of the box by rounding.
double twice_midpoint(const Reference& reference, int axis) {
  return double{reference.box_min[axis]} + reference.box_max[axis];
}

struct Plane {
  int axis;
  float position;

  bool crosses(const Reference& reference) const {
    return reference.box_min[axis] < position && reference.box_max[axis] > position;
  }
  // A reference that the plane does not cross lies on that side of it, or in it.
  bool has_midpoint_on_left(const Reference& reference) const {
    return twice_midpoint(reference, axis) < 2 * double{position};
  }
};

// In the middle of the midpoints' bounds; none where all midpoints coincide.
std::optional<Plane> median_plane(std::span<const Reference> references) {
  double low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = twice_midpoint(references[0], axis);
  for (const Reference& reference : references) {
    for (int axis = 0; axis < 3; ++axis) {
      const double midpoint = twice_midpoint(reference, axis);
      low[axis] = midpoint < low[axis] ? midpoint : low[axis];
      high[axis] = midpoint > high[axis] ? midpoint : high[axis];
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  }
  if (!(low[longest] < high[longest])) return {};
  return Plane{longest, static_cast<float>(0.25 * low[longest] + 0.25 * high[longest])};
}

// Both children of a split, measured.
struct Measured {
  GrowingBox left, right;
  std::uint32_t left_count = 0, right_count = 0;

  template <class Box>
  void add(const Box& box, bool on_left) {
    (on_left ? left : right).grow(box);
    ++(on_left ? left_count : right_count);
  }
  double cost() const { return left.half_area() * left_count + right.half_area() * right_count; }
};

void push(SplitSides& sides, const Reference& reference, bool on_left) {
  on_left ? sides.push_left(reference) : sides.push_right(reference);
}

class Gd16Splitter : public ReferenceSplitter {
 public:
  Gd16Splitter(std::span<const Triangle> triangles, const Gd16Config& config)
      : triangles_(triangles), config_(config) {}

  void split(const ReferenceSet& set, SplitSides& sides) const override {
    const std::optional<Plane> plane = median_plane(set.references);
    if (!plane) return;
    const auto crossed = static_cast<std::uint32_t>(
        std::ranges::count_if(set.references, [&](const Reference& r) { return plane->crosses(r); }));
    const bool fits = crossed <= set.spare;

    Measured whole;
    for (const Reference& reference : set.references) {
      whole.add(reference, plane->has_midpoint_on_left(reference));
    }
    double cost = whole.cost();
    bool clips = false;
    // Where clipped parts do not fit, their cost only matters to tell that the cap was reached, once.
    if (crossed > 0 && (fits || !cap_reached_)) {
      const double clipped_cost = clip_all(set.references, *plane, fits ? &sides : nullptr);
      if (clipped_cost < cost) {
        clips = fits;
        if (fits) cost = clipped_cost;
        if (!fits) cap_reached_ = sides.cap_reached = true;
      }
    }
    if (ends_early(set.references, whole, cost)) {
      halve(set.references, plane->axis, sides);
    } else if (!clips) {
      sides.clear();
      for (const Reference& reference : set.references) {
        push(sides, reference, plane->has_midpoint_on_left(reference));
      }
    }
  }

 private:
  // The cost of the split that clips, and the split itself where there are sides for it.
  double clip_all(std::span<const Reference> references, const Plane& plane, SplitSides* sides) const {
    Measured clipped;
    const auto add = [&](const Reference& reference, bool on_left) {
      clipped.add(reference, on_left);
      if (sides) push(*sides, reference, on_left);
    };
    for (const Reference& reference : references) {
      const bool on_left = plane.has_midpoint_on_left(reference);
      if (!plane.crosses(reference)) {
        add(reference, on_left);
        continue;
      }
      const ClippedBoxes parts = clip_at_plane(
          triangles_[reference.child], {reference.box_min, reference.box_max}, plane.axis, plane.position);
      if (!parts.left.is_empty()) add(with_box(reference, parts.left), true);
      if (!parts.right.is_empty()) add(with_box(reference, parts.right), false);
      // Its box only comes near the triangle; but none may vanish without need.
      if (parts.left.is_empty() && parts.right.is_empty()) add(reference, on_left);
    }
    return clipped.cost();
  }

  static Reference with_box(const Reference& reference, const GrowingBox& box) {
    return {box.box_min, reference.child, box.box_max, 0};
  }

  // The paper's leaf: E_t = C_t A(n) N(n) against C_i A(n) + C_t * cost, C_i = C_t = 1.
  bool ends_early(std::span<const Reference> references, const Measured& whole, double cost) const {
    if (!config_.early_termination || references.size() > config_.leaf_references) return false;
    GrowingBox box = whole.left;
    box.grow(whole.right);
    return box.half_area() * static_cast<double>(references.size()) <= box.half_area() + cost;
  }

  // The paper's leaf as a subtree: in order of the midpoints, halves down to its references.
  static void halve(std::span<const Reference> references, int axis, SplitSides& sides) {
    std::vector<Reference> ordered(references.begin(), references.end());
    std::ranges::stable_sort(ordered, {}, [=](const Reference& r) { return twice_midpoint(r, axis); });
    sides.clear();
    for (std::size_t i = 0; i < ordered.size(); ++i) push(sides, ordered[i], i < ordered.size() / 2);
    sides.halve_below = true;
  }

  std::span<const Triangle> triangles_;
  const Gd16Config& config_;
  mutable std::atomic<bool> cap_reached_ = false;
};

}  // namespace

Bvh build_gd16(std::span<const Triangle> triangles, const Gd16Config& config) {
  return build_reference_tree(triangles, config.reference_cap, Gd16Splitter(triangles, config),
                              config.threads);
}

}  // namespace coppice
