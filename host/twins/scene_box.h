#pragma once

#include <algorithm>

#include "twins/normalised.h"

namespace coppice::twins {

// Counts an active primitive, and stretches the scene's box over its own.
inline void add_box(BuildState& state, const Aabb& box) {
  ++state.active_count;
  for (int axis = 0; axis < 3; ++axis) {
    state.box_min_complement[axis] = std::max(state.box_min_complement[axis], ~ordered(box.box_min[axis]));
    state.box_max[axis] = std::max(state.box_max[axis], ordered(box.box_max[axis]));
  }
}

}  // namespace coppice::twins
