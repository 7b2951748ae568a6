#pragma once

#include <cstdint>
#include <vector>

#include "interface/trace.h"

namespace coppice {

// The same numbers on every run: a linear congruential generator.
class CheckRandom {
 public:
  std::uint32_t next_word() { return state_ = state_ * 1664525u + 1013904223u; }
  // A multiple of 2^-24 in [0, 1).
  float next() { return static_cast<float>(next_word() >> 8) * 0x1p-24f; }
  vec3 next_vec3() {
    const float x = next(), y = next();
    return {x, y, next()};
  }
  // From -1 to 1.
  float next_signed() { return 2 * next() - 1; }
  vec3 next_signed_vec3() { return 2.0f * next_vec3() - vec3(1); }

 private:
  std::uint32_t state_ = 1;
};

std::vector<uint> random_words(std::size_t count);

// In the unit cube, with edges of 0.01.
std::vector<Triangle> scattered_triangles(std::uint32_t count);

// A tree of so many boxes in a row: of the two children of a node the first is a leaf.
std::vector<Node> chain_of_boxes(std::uint32_t count);

// Of a small picture, packets of which go the same way, and others that do not; into the unit cube.
std::vector<Ray> check_rays();

}  // namespace coppice
