#include <algorithm>
#include <limits>

#include "interface/bounds.h"
#include "twins/count_error.h"
#include "twins/finite.h"
#include "twins/scene_box.h"

namespace coppice::twins {

void primitive_bounds(const PrimitiveBoundsArgs& args) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  note_count(args.state[0], args.count_at, args.triangle_count);
  const uint count = counted(args.count_at, args.triangle_count);
  for (uint i = 0; i < count; ++i) {
    const Triangle& triangle = args.triangles[i];
    Aabb box{vec3(infinity), vec3(-infinity)};
    if (all_finite(triangle.a) && all_finite(triangle.b) && all_finite(triangle.c)) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto [least, greatest] = std::minmax({triangle.a[axis], triangle.b[axis], triangle.c[axis]});
        box.box_min[axis] = least;
        box.box_max[axis] = greatest;
      }
      add_box(args.state[0], box);
    }
    args.boxes[i] = box;
  }
}

}  // namespace coppice::twins
