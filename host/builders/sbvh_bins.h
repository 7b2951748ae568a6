#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "builders/lane_box.h"
#include "builders/reference_tree.h"
#include "builders/sah_bins.h"

namespace coppice {

// Costs are A(left) N_left + A(right) N_right, A being half of the surface area in the units of lane_box.h.

// Both children of an object split, which tells references apart by the bins of their midpoints.
struct ObjectSplit {
  BinGrid grid;
  BinSplit place;
  float cost;
  LaneBox left, right;

  bool goes_left(const Reference& reference) const {
    return grid.bins_of(lane_box(reference))[place.axis] < place.first_bin;
  }
};

// A reference that is on neither side is crossed by the plane.
struct SpatialSplit {
  float cost = std::numeric_limits<float>::infinity();  // infinite: no plane has references on both sides
  int axis = 0;
  float plane = 0;
  LaneBox left = EMPTY_LANE_BOX, right = EMPTY_LANE_BOX;  // around the parts on either side

  bool is_left(const Reference& reference) const { return reference.box_max[axis] <= plane; }
  bool is_right(const Reference& reference) const {
    return !is_left(reference) && reference.box_min[axis] >= plane;
  }
};

// The box of a node's references.
LaneBox box_of(const ReferenceSet& set);

// The cheapest split between bins of midpoints, over all axes; none where all midpoints coincide.
std::optional<ObjectSplit> find_object_split(const ReferenceSet& set, float scale);

// The cheapest split at a plane between bins of space, over all axes, with all that it crosses on both sides.
// `box` is that of the references.
SpatialSplit find_spatial_split(const ReferenceSet& set, std::span<const Triangle> triangles,
                                const LaneBox& box, float scale);

}  // namespace coppice
