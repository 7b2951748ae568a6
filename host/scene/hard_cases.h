#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scene/scene.h"

namespace coppice {

// An input that is hard on a builder or a tracer: ties, chains, zero extents, the ends of the range of float.
struct HardCase {
  std::string_view name;
  std::string_view description;  // one line
  std::uint32_t default_triangle_count;
  // Makes the case with exactly `triangle_count` triangles. Pure: the same arguments give the same bits.
  // Cases without randomness ignore the seed.
  Scene (*make)(std::uint32_t triangle_count, std::uint64_t seed);
};

// All hard cases, in the order in which they are listed to the user.
std::span<const HardCase> hard_cases();

// The case of that name, or null.
const HardCase* find_hard_case(std::string_view name);

}  // namespace coppice
