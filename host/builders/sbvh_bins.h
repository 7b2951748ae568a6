#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "builders/clip.h"
#include "builders/reference_tree.h"

namespace coppice {

// The bounds of a node's references, and of their midpoints.
struct NodeBounds {
  GrowingBox box;
  double low[3], high[3];  // of the midpoints times two: in double, which no box of floats overflows

  explicit NodeBounds(std::span<const Reference> references);
};

inline constexpr std::uint32_t SBVH_MAX_BINS = 32;

// Costs are A(left) N_left + A(right) N_right, A being half of the surface area.
struct ObjectSplit {
  double cost = std::numeric_limits<double>::infinity();  // infinite: all midpoints coincide
  int axis = 0;
  std::uint32_t first_right_bin = 0;
  double low = 0, bins_per_length = 0;
  std::uint32_t bin_count = 0;
  GrowingBox left, right;

  bool goes_left(const Reference& reference) const;
};

// A reference that is on neither side is crossed by the plane.
struct SpatialSplit {
  double cost = std::numeric_limits<double>::infinity();  // infinite: no plane has references on both sides
  int axis = 0;
  float plane = 0;
  GrowingBox left, right;  // around the parts on either side

  bool is_left(const Reference& reference) const { return reference.box_max[axis] <= plane; }
  bool is_right(const Reference& reference) const {
    return !is_left(reference) && reference.box_min[axis] >= plane;
  }
};

// The cheapest split between bins of midpoints, over all axes.
ObjectSplit find_object_split(std::span<const Reference> references, const NodeBounds& bounds);

// The cheapest split at a plane between bins of space, over all axes, with all that it crosses on both sides.
SpatialSplit find_spatial_split(std::span<const Reference> references, std::span<const Triangle> triangles,
                                const GrowingBox& box);

}  // namespace coppice
