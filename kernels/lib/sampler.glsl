// Low-discrepancy points in [0, 1): Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4): the first two
// dimensions of Sobol's sequence, shuffled and scrambled anew for each pixel and each `dimension` (padding). Samples 0
// to 2^k - 1 of a pixel and dimension are a (0, k, 2)-net, k up to 24; of different ones they are independent. Integer
// arithmetic alone.
#ifndef COPPICE_LIB_SAMPLER
#define COPPICE_LIB_SAMPLER
#include "lib/random.glsl"

// Each bit flipped or not by a hash of the bits below it: Laine and Karras 2011, "Stratified Sampling for Stochastic
// Transparency", with the constants of Vegdahl 2021, "Building a Better LK Hash".
uint permuted_upwards(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

// Owen's scrambling (Owen 1995): a bit by those above it.
uint owen_scrambled(uint x, uint seed) { return bitfieldReverse(permuted_upwards(bitfieldReverse(x), seed)); }

// Sobol's second dimension, its bits from last to first: column j of its matrix is row j of Pascal's triangle mod 2,
// and binomial(j, i) is odd where the bits of i are among those of j. So bit i is the sum of all such bits j.
uint sobol_second(uint index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ ((index >> 16) & 0x0000ffffu);
}

// In [0, 1), a multiple of 2^-24, of the bits of a fraction from last to first.
float fraction_of_reversed(uint bits) { return float(bitfieldReverse(bits) >> 8) * 5.9604644775390625e-8; }

// The state from which a pixel and dimension draw their seeds.
uint seeds_of(uint pixel_seed, uint dimension) {
  uint state = pixel_seed;
  return next_random(state) ^ (dimension * 0x9e3779b9u);
}

// A dimension is a number of the caller's choice, of one use in a path, be it of one number or of two.
vec2 sample_2d(uint pixel_seed, uint sample_index, uint dimension) {
  uint state = seeds_of(pixel_seed, dimension);
  uint index = owen_scrambled(sample_index, next_random(state));
  float x = fraction_of_reversed(permuted_upwards(index, next_random(state)));
  return vec2(x, fraction_of_reversed(permuted_upwards(sobol_second(index), next_random(state))));
}

// The first of the two numbers of sample_2d.
float sample_1d(uint pixel_seed, uint sample_index, uint dimension) {
  uint state = seeds_of(pixel_seed, dimension);
  uint index = owen_scrambled(sample_index, next_random(state));
  return fraction_of_reversed(permuted_upwards(index, next_random(state)));
}

#endif
