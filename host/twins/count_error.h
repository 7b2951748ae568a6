#pragma once

#include "twins/device_count.h"

namespace coppice::twins {

// Keeps how many primitives, keys or words were asked for.
inline void note_count(BuildState& state, Address<const uint> at, uint most) {
  state.primitive_count = at.value == 0 ? most : at[0];
  if (state.primitive_count > most) state.error_word |= ERROR_COUNT;
}

// The same of rays, whose number nobody keeps.
inline void note_ray_count(BuildState& state, Address<const uint> at, uint most) {
  if (at.value != 0 && at[0] > most) state.error_word |= ERROR_RAY_COUNT;
}

}  // namespace coppice::twins
