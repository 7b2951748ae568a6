#pragma once

#include <cstdint>

namespace coppice::twins {

// A point of the unit circle, by the polynomials of interface/circle.h.
struct OnCircle {
  float cos, sin;
};

// Of `whole` quarter turns, not negative, and x more, from -1/2 to 1/2.
OnCircle circle_beside_quarter(int whole, float x);

OnCircle circle_at(float turns);

// `part` of a turn of 2^32.
OnCircle circle_at_part(std::uint32_t part);

}  // namespace coppice::twins
