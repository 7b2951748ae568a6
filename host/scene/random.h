#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace coppice {

// PCG32 (O'Neill 2014) with the draws that the generators need. The distributions of the standard library
// give other numbers in other libraries; these are the same everywhere. Note that arguments of a call are
// evaluated in any order: draw more than one number only in braces or in separate statements.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(0) {
    next();
    state_ += seed;
    next();
  }

  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005u + 1442695040888963407u;
    const auto xorshifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto rotation = static_cast<std::uint32_t>(old >> 59);
    return (xorshifted >> rotation) | (xorshifted << ((32 - rotation) & 31));
  }

  // A multiple of 2^-24 in [0, 1).
  float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24f; }
  // In [low, high).
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  // In [0, count); `count` is at least 1. Biased by less than count / 2^32.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>((std::uint64_t{next()} * count) >> 32);
  }
  // In the cube [-1, 1)^3.
  glm::vec3 in_cube() {
    const float x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    return {x, y, z};
  }
  // A point of the unit sphere, by rejection.
  glm::vec3 direction() {
    while (true) {
      const glm::vec3 p = in_cube();
      const float square = p.x * p.x + p.y * p.y + p.z * p.z;
      if (square > 0.01f && square <= 1.0f) return p / std::sqrt(square);
    }
  }

 private:
  std::uint64_t state_;
};

// (cos, sin) of an angle given in turns, by a polynomial: unlike the library's, the same bits everywhere. To
// 4e-4.
inline glm::vec2 turn_to_circle(float turns) {
  const float quarter = 4.0f * (turns - std::floor(turns));  // in quarter turns, 0 to 4
  const float whole = std::floor(quarter + 0.5f);
  const float x = (quarter - whole) * 1.57079633f;  // at most an eighth of a turn
  const float square = x * x;
  const float c = 1.0f - square * (0.5f - square * (1.0f / 24.0f));
  const float s = x * (1.0f - square * (1.0f / 6.0f - square * (1.0f / 120.0f)));
  switch (static_cast<int>(whole) & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

}  // namespace coppice
