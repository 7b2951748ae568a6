#pragma once

#include "interface/paths.h"
#include "twins/bsdf.h"

namespace coppice::twins {

// Of a path: the number that sample_2d takes for this use, one of PATH_PICKS_LIGHT and so on.
uint path_dimension(uint bounce, uint use);

// How many paths are in the queue.
uint paths_in_queue(const Address<const uint>& count_at, uint most);

// 1 / (1 + ratio^2): Veach and Guibas 1995, the power heuristic with exponent 2.
float power_weight(float ratio);

// The unit normal on the side that a ray of this direction comes from.
vec3 normal_towards(const Triangle& triangle, const vec3& direction);

// Of PATH_LOBE_.
BsdfSwitches switches_of(uint lobes);

inline constexpr float PI_FLOAT = 3.14159274f;

}  // namespace coppice::twins
