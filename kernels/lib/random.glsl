// Hash of a counter: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", PCG.
#ifndef COPPICE_LIB_RANDOM
#define COPPICE_LIB_RANDOM

uint next_random(inout uint state) {
  state = state * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

// In [-1, 1), a multiple of 2^-23.
float next_signed(inout uint state) { return float(int(next_random(state)) >> 8) * 1.1920928955078125e-7; }

#endif
