#pragma once

#include "interface/trace.h"

namespace coppice::twins {

// Adds to a 64-bit sum of two words.
inline void count_into(uvec2& counter, std::uint64_t value) {
  const std::uint64_t sum = (std::uint64_t{counter.y} << 32 | counter.x) + value;
  counter = {static_cast<uint>(sum), static_cast<uint>(sum >> 32)};
}

// Where the steps of each ray are kept.
template <class Args>
void keep_ray_steps(const Args& args, uint ray, uint steps) {
  if (args.ray_steps.value != 0) args.ray_steps[ray] = steps;
}

}  // namespace coppice::twins
