#include <cstring>
#include <limits>

#include "interface/bounds.h"
#include "twins/count_error.h"
#include "twins/finite.h"
#include "twins/scene_box.h"

namespace coppice::twins {

void box_bounds(const BoxBoundsArgs& args) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  note_count(args.state[0], args.count_at, args.box_count);
  const uint count = counted(args.count_at, args.box_count);
  for (std::uint64_t i = 0; i < count; ++i) {
    Aabb box;
    std::memcpy(&box, reinterpret_cast<const void*>(args.given.value + i * args.stride), sizeof box);
    bool active = all_finite(box.box_min) && all_finite(box.box_max);
    for (int axis = 0; axis < 3; ++axis) {
      box.box_min[axis] = flushed(box.box_min[axis]);
      box.box_max[axis] = flushed(box.box_max[axis]);
      active = active && box.box_min[axis] <= box.box_max[axis];
    }
    if (active) add_box(args.state[0], box);
    args.boxes[i] = active ? box : Aabb{vec3(infinity), vec3(-infinity)};
  }
}

}  // namespace coppice::twins
