#pragma once

#include <algorithm>

#include "interface/types.h"

namespace coppice::twins {

// A count that only the device knows: at most `most`, which is the count where there is no address.
inline uint counted(Address<const uint> at, uint most) {
  return at.value == 0 ? most : std::min(at[0], most);
}

}  // namespace coppice::twins
