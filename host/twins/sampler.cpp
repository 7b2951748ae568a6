#include "twins/sampler.h"

namespace coppice::twins {

namespace {

// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering": PCG.
uint pcg_word(uint& state) {
  state = state * 747796405u + 2891336453u;
  const uint word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

uint reversed_bits(uint x) {
  uint result = 0;
  for (int bit = 0; bit < 32; ++bit) result = result << 1 | (x >> bit & 1);
  return result;
}

// Laine and Karras 2011, with Vegdahl's constants of 2021, between two reversals: each bit depends on those
// above it alone.
uint owen_scramble(uint fraction, uint seed) {
  uint x = reversed_bits(fraction);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= seed >> 16 | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reversed_bits(x);
}

// The fractions of a point of Sobol's sequence, from their direction numbers: 1/2, 1/4, 1/8 ... and for the
// second dimension, of the polynomial x + 1, each the one before plus half of it, without carry.
struct SobolPoint {
  uint x = 0, y = 0;

  explicit SobolPoint(uint index) {
    uint first = 1u << 31, second = 1u << 31;
    for (; index != 0; index >>= 1, first >>= 1, second ^= second >> 1) {
      if ((index & 1) == 0) continue;
      x ^= first;
      y ^= second;
    }
  }
};

float unit_fraction(uint fraction) { return static_cast<float>(fraction >> 8) * 0x1p-24f; }

}  // namespace

glm::vec2 sample_2d(uint pixel_seed, uint sample_index, uint dimension) {
  uint state = pixel_seed;
  state = pcg_word(state) ^ (dimension * 0x9e3779b9u);
  const uint for_order = pcg_word(state), for_x = pcg_word(state), for_y = pcg_word(state);
  const SobolPoint point(owen_scramble(sample_index, for_order));
  return {unit_fraction(owen_scramble(point.x, for_x)), unit_fraction(owen_scramble(point.y, for_y))};
}

float sample_1d(uint pixel_seed, uint sample_index, uint dimension) {
  return sample_2d(pixel_seed, sample_index, dimension).x;
}

}  // namespace coppice::twins
