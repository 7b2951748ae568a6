#pragma once

#include <cstdint>

namespace coppice::twins {

// A point of the unit circle, by the polynomials of interface/circle.h.
struct OnCircle {
  float cos, sin;
};

OnCircle circle_at(float turns);

// `part` of a turn of 2^32.
OnCircle circle_at_part(std::uint32_t part);

}  // namespace coppice::twins
