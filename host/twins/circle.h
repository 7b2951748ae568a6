#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace coppice::twins {

// A point of the unit circle, by the polynomials of interface/circle.h.
struct OnCircle {
  float cos, sin;
};

// Of `whole` quarter turns, not negative, and x more, from -1/2 to 1/2.
OnCircle circle_beside_quarter(int whole, float x);

OnCircle circle_at(float turns);

// A point of the unit disk, evenly of u in [0, 1): Shirley and Chiu 1997, "A Low Distortion Map Between Disk
// and Square".
struct OnDisk {
  float x, y;
  float radius;  // of either sign
};
OnDisk disk_at(const glm::vec2& u);

// `part` of a turn of 2^32.
OnCircle circle_at_part(std::uint32_t part);

}  // namespace coppice::twins
