#include "builders/clip.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace coppice {
namespace {

// The nearest float below a finite one, or above.
float float_below(float value) {
  if (value == 0.0f) return -std::numeric_limits<float>::denorm_min();
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return std::bit_cast<float>(value > 0.0f ? bits - 1 : bits + 1);
}
float float_above(float value) { return -float_below(-value); }

// The greatest float that is <= value, and the least that is >= value, for values in the range of float.
float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest > value ? float_below(nearest) : nearest;
}
float rounded_up(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest < value ? float_above(nearest) : nearest;
}

// Grows both sides by the point where the edge from `a` to `b` crosses the plane; a[axis] < plane < b[axis].
//
// No point is lost: let y be the true coordinate of the crossing on another axis, M = max(|a_y|, |b_y|) and
// u = 2^-53. The two differences along `axis` and their quotient t in (0, 1) err by u each, so t by a factor
// within 1 +- 3u (terms in u^2 left out); b_y - a_y and its product with t add u each, and since
// |b_y - a_y| <= 2M the product errs by at most 10uM. The sum with a_y, no larger than M, adds uM, and moving
// it outward by `margin` = 16uM another uM: 12uM < 16uM, so that y lies between `low` and `high`. Nothing
// overflows or underflows, since products and quotients of two floats are far inside the range of double. y
// lies between a_y and b_y too, which are floats, so clamping loses nothing and the rounding stays between
// them.
void grow_by_crossing(ClippedBoxes& sides, const vec3& a, const vec3& b, int axis, float plane) {
  const double t = (double{plane} - a[axis]) / (double{b[axis]} - a[axis]);
  for (int other = 0; other < 3; ++other) {
    if (other == axis) continue;
    const double from = a[other], to = b[other];
    const double least = std::min(from, to), most = std::max(from, to);
    const double y = from + t * (to - from);
    const double margin = 0x1p-49 * std::max(std::abs(from), std::abs(to));
    const float low = rounded_down(std::clamp(y - margin, least, most));
    const float high = rounded_up(std::clamp(y + margin, least, most));
    for (GrowingBox* side : {&sides.left, &sides.right}) {
      side->box_min[other] = std::min(side->box_min[other], low);
      side->box_max[other] = std::max(side->box_max[other], high);
    }
  }
  for (GrowingBox* side : {&sides.left, &sides.right}) {
    side->box_min[axis] = std::min(side->box_min[axis], plane);
    side->box_max[axis] = std::max(side->box_max[axis], plane);
  }
}

}  // namespace

// The triangle at coordinates <= plane is the convex hull of its corners there and of the crossings of its
// edges, and so is the other side: each box around those points holds its side of the whole triangle, and its
// intersection with `box` the side of the part in `box`.
ClippedBoxes clip_at_plane(const Triangle& triangle, const GrowingBox& box, int axis, float plane) {
  ClippedBoxes sides;
  const vec3* corners[3] = {&triangle.a, &triangle.b, &triangle.c};
  for (int i = 0; i < 3; ++i) {
    const vec3& corner = *corners[i];
    if (corner[axis] <= plane) sides.left.grow(Aabb{corner, corner});
    if (corner[axis] >= plane) sides.right.grow(Aabb{corner, corner});
    // From the lower to the higher end, so that both triangles at an edge find the same crossing.
    const vec3& next = *corners[i == 2 ? 0 : i + 1];
    if (corner[axis] < plane && next[axis] > plane) {
      grow_by_crossing(sides, corner, next, axis, plane);
    } else if (corner[axis] > plane && next[axis] < plane) {
      grow_by_crossing(sides, next, corner, axis, plane);
    }
  }
  sides.left.shrink(box);
  sides.right.shrink(box);
  return sides;
}

}  // namespace coppice
