#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scene/scene.h"

namespace coppice {

// The smallest mesh that a closed case makes.
inline constexpr std::uint32_t LEAST_CLOSED_TRIANGLES = 14;

// An input that is hard on a builder or a tracer: ties, chains, zero extents, the ends of the range of float.
struct HardCase {
  std::string_view name;
  std::string_view description;  // one line
  std::uint32_t default_triangle_count;
  // Makes the case with exactly triangle_count(asked) triangles. Pure: the same arguments give the same bits.
  // Cases without randomness ignore the seed.
  Scene (*make)(std::uint32_t asked, std::uint64_t seed);
  // Whether the case is a watertight mesh: each edge belongs to exactly two triangles, which share its two
  // vertices by index and run through it in opposite directions; normals point outwards. The centre of its
  // bounding box lies inside, so every ray from there hits.
  bool closed = false;

  // The number of triangles for a number asked for: just that, but for a closed mesh, which always has an
  // even number of them, the next even number, at least LEAST_CLOSED_TRIANGLES.
  std::uint32_t triangle_count(std::uint32_t asked) const;
};

// All hard cases, in the order in which they are listed to the user.
std::span<const HardCase> hard_cases();

// The case of that name, or null.
const HardCase* find_hard_case(std::string_view name);

}  // namespace coppice
