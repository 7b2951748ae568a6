#pragma once

#include "interface/trace.h"
#include "twins/alpha.h"
#include "twins/intersect.h"

namespace coppice::twins {

// Which primitives one ray sees, and where they let it through; of the arguments of any trace.
class Sight {
 public:
  Sight() = default;  // of a ray that sees all

  template <class Args>
  Sight(const Args& args, uint ray) : flags_(args.primitive_flags), mask_(args.ray_mask) {
    if (args.ray_masks.value != 0) mask_ &= args.ray_masks[ray];
    if constexpr (requires { args.alpha_maps; }) alpha_ = Alpha(args, args.rays[ray]);
  }

  bool sees(uint primitive) const { return (flags_of(primitive) & mask_ & PRIMITIVE_MASK) != 0; }
  bool sees_opaque(uint primitive) const {
    return sees(primitive) && (flags_of(primitive) & PRIMITIVE_NOT_OPAQUE) == 0;
  }

  // As ray_meets_triangle, but for a hit where the triangle lets the ray through.
  void meet(const TraceRay& ray, const Triangle& triangle, uint index, uint triangle_test, Hit& hit) const {
    Hit met = hit;
    ray_meets_triangle(ray, triangle, index, triangle_test, met);
    if (met.triangle != hit.triangle && !alpha_.lets_through(met)) hit = met;
  }

 private:
  uint flags_of(uint primitive) const {
    return flags_.value == 0 ? PRIMITIVE_FLAGS_DEFAULT : flags_[primitive];
  }

  Address<const uint> flags_{};
  uint mask_ = PRIMITIVE_MASK;
  Alpha alpha_;
};

}  // namespace coppice::twins
