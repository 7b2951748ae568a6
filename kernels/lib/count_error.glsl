// Counts on the device that are larger than the most.
#ifndef COPPICE_LIB_COUNT_ERROR
#define COPPICE_LIB_COUNT_ERROR
#include "lib/device_count.glsl"

// Keeps how many primitives, keys or words were asked for. This and the next one are called by one invocation of the
// dispatch. Partners: who sets other bits of the error word.
void note_count(BuildStateBuffer state, UintBuffer at, uint most) {
  uint asked = uint64_t(at) == 0ul ? most : at.at[0];
  state.at[0].primitive_count = asked;
  if (asked > most) atomicOr(state.at[0].error_word, ERROR_COUNT);
}

// The same of rays, whose number nobody keeps.
void note_ray_count(BuildStateBuffer state, UintBuffer at, uint most) {
  if (uint64_t(at) != 0ul && at.at[0] > most) atomicOr(state.at[0].error_word, ERROR_RAY_COUNT);
}

#endif
