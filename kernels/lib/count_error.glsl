// Keeps how many primitives, keys or words were asked for.
#include "lib/device_count.glsl"

// By one invocation of the dispatch. Partners: who sets other bits of the error word.
void note_count(BuildStateBuffer state, UintBuffer at, uint most) {
  uint asked = uint64_t(at) == 0ul ? most : at.at[0];
  state.at[0].primitive_count = asked;
  if (asked > most) atomicOr(state.at[0].error_word, ERROR_COUNT);
}
