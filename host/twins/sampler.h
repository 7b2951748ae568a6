#pragma once

#include "interface/types.h"

namespace coppice::twins {

// Points of Sobol's first two dimensions with Owen's scrambling by a hash: Burley 2020, "Practical Hash-based
// Owen Scrambling", JCGT 9(4). In [0, 1), multiples of 2^-24. Samples 0 to 2^k - 1 of one pixel and dimension
// are a (0, k, 2)-net, k up to 24; pixels and dimensions are independent of each other.
glm::vec2 sample_2d(uint pixel_seed, uint sample_index, uint dimension);

// The first number of sample_2d.
float sample_1d(uint pixel_seed, uint sample_index, uint dimension);

}  // namespace coppice::twins
