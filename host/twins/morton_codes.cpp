#include <algorithm>
#include <cmath>

#include "interface/morton.h"
#include "twins/device_count.h"
#include "twins/normalised.h"

namespace coppice::twins {

namespace {

// A cubic grid of 2^bits cells a side over the scene's box, the cell a power of two.
struct Grid {
  vec3 origin;
  int scale_exponent;
  bool flat;  // all boxes at one point

  Grid(const Normalisation& normalise, uint bits) : origin(normalise(normalise.scene_box().box_min)) {
    const vec3 end = normalise(normalise.scene_box().box_max);
    const float largest = std::max({end.x - origin.x, end.y - origin.y, end.z - origin.z});
    flat = largest == 0;
    scale_exponent = flat ? 0 : static_cast<int>(bits) - 1 - std::ilogb(largest);
  }

  uint cell(float box_min, float box_max, int axis) const {
    if (flat) return 0;
    const float centre = (box_min + box_max) * 0.5f;
    return static_cast<uint>(std::ldexp(centre - origin[axis], scale_exponent));
  }
};

}  // namespace

void morton_codes(const MortonCodesArgs& args) {
  const uint count = counted(args.count_at, args.triangle_count);
  if (count == 0) return;
  const Normalisation normalise(args.state[0]);
  const Grid grid(normalise, 10 * args.key_words);
  for (uint i = 0; i < count; ++i) {
    uint* key = &args.keys[std::size_t{i} * args.key_words];
    args.values[i] = i;
    if (args.boxes[i].box_min.x > args.boxes[i].box_max.x) {
      std::fill_n(key, args.key_words, MORTON_INACTIVE);
      continue;
    }
    std::fill_n(key, args.key_words, 0u);
    const vec3 box_min = normalise(args.boxes[i].box_min), box_max = normalise(args.boxes[i].box_max);
    for (int axis = 0; axis < 3; ++axis) {
      const uint cell = grid.cell(box_min[axis], box_max[axis], axis);
      for (uint bit = 0; bit < 10 * args.key_words; ++bit) {
        key[bit / 10] |= (cell >> bit & 1u) << (3 * (bit % 10) + 2 - axis);
      }
    }
  }
}

}  // namespace coppice::twins
