#pragma once

#include "interface/trace.h"

namespace coppice::twins {

// Which primitives one ray sees; of the arguments of any trace.
class Sight {
 public:
  Sight() = default;  // of a ray that sees all

  template <class Args>
  Sight(const Args& args, uint ray) : flags_(args.primitive_flags), mask_(args.ray_mask) {
    if (args.ray_masks.value != 0) mask_ &= args.ray_masks[ray];
  }

  bool sees(uint primitive) const { return (flags_of(primitive) & mask_ & PRIMITIVE_MASK) != 0; }
  bool sees_opaque(uint primitive) const {
    return sees(primitive) && (flags_of(primitive) & PRIMITIVE_NOT_OPAQUE) == 0;
  }

 private:
  uint flags_of(uint primitive) const {
    return flags_.value == 0 ? PRIMITIVE_FLAGS_DEFAULT : flags_[primitive];
  }

  Address<const uint> flags_{};
  uint mask_ = PRIMITIVE_MASK;
};

}  // namespace coppice::twins
