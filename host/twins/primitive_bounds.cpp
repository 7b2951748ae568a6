#include <algorithm>
#include <cmath>
#include <limits>

#include "interface/bounds.h"
#include "twins/count_error.h"
#include "twins/normalised.h"

namespace coppice::twins {

namespace {

bool is_active(const Triangle& triangle) {
  for (const vec3& corner : {triangle.a, triangle.b, triangle.c}) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(corner[axis])) return false;
    }
  }
  return true;
}

}  // namespace

void primitive_bounds(const PrimitiveBoundsArgs& args) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  BuildState& state = args.state[0];
  note_count(state, args.count_at, args.triangle_count);
  const uint count = counted(args.count_at, args.triangle_count);
  for (uint i = 0; i < count; ++i) {
    const Triangle& triangle = args.triangles[i];
    Aabb box{vec3(infinity), vec3(-infinity)};
    if (is_active(triangle)) {
      ++state.active_count;
      for (int axis = 0; axis < 3; ++axis) {
        const auto [least, greatest] = std::minmax({triangle.a[axis], triangle.b[axis], triangle.c[axis]});
        box.box_min[axis] = least;
        box.box_max[axis] = greatest;
        state.box_min_complement[axis] = std::max(state.box_min_complement[axis], ~ordered(least));
        state.box_max[axis] = std::max(state.box_max[axis], ordered(greatest));
      }
    }
    args.boxes[i] = box;
  }
}

}  // namespace coppice::twins
