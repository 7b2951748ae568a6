#pragma once

#include <limits>

#include "interface/types.h"

namespace coppice {

// A box that grows around others; empty at first.
struct GrowingBox {
  vec3 box_min{std::numeric_limits<float>::infinity()};
  vec3 box_max{-std::numeric_limits<float>::infinity()};

  template <class Box>  // Aabb, Node or GrowingBox
  void grow(const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      box_min[axis] = box.box_min[axis] < box_min[axis] ? box.box_min[axis] : box_min[axis];
      box_max[axis] = box.box_max[axis] > box_max[axis] ? box.box_max[axis] : box_max[axis];
    }
  }

  // Keeps what lies in the other box too.
  void shrink(const GrowingBox& other) {
    for (int axis = 0; axis < 3; ++axis) {
      box_min[axis] = other.box_min[axis] > box_min[axis] ? other.box_min[axis] : box_min[axis];
      box_max[axis] = other.box_max[axis] < box_max[axis] ? other.box_max[axis] : box_max[axis];
    }
  }

  bool is_empty() const {
    return !(box_min.x <= box_max.x && box_min.y <= box_max.y && box_min.z <= box_max.z);
  }

  // Half of the surface area; 0 for an empty box. In double, so that no box of floats overflows or
  // underflows.
  double half_area() const {
    if (is_empty()) return 0.0;
    const double x = double{box_max.x} - box_min.x;
    const double y = double{box_max.y} - box_min.y;
    const double z = double{box_max.z} - box_min.z;
    return x * y + y * z + z * x;
  }
};

// The two sides of a plane; a side that the triangle does not reach is empty.
struct ClippedBoxes {
  GrowingBox left, right;
};

// `box` holds a part of an active triangle, box_min[axis] < plane < box_max[axis]. `left` and `right` hold
// what that part has at coordinates <= plane and >= plane: every point of the triangle in `box` lies in one
// of them, and those in the plane in both. They lie inside of `box`. A crossing of an edge is rounded
// outward, by at most two ulps of the edge's largest coordinate on that axis. Both may be empty where `box`
// only comes near the triangle.
ClippedBoxes clip_at_plane(const Triangle& triangle, const GrowingBox& box, int axis, float plane);

}  // namespace coppice
