#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "builders/normalised_space.h"
#include "interface/types.h"

namespace coppice {

class Threads;

// What the builders that go by Morton codes start from: the leaves of the active triangles by triangle index,
// and their order along the curve.
struct MortonLeaves {
  std::vector<Node> leaves;
  std::vector<std::uint64_t> codes;  // of the leaves
  std::vector<std::uint32_t> order;  // the leaves, ascending by (code, triangle index)
  NormalisedSpace to_normalised;     // of the scene

  std::size_t count() const { return leaves.size(); }
  const Node& leaf(std::size_t place) const { return leaves[order[place]]; }
  std::uint64_t code(std::size_t place) const { return codes[order[place]]; }
};

// Codes of `morton_bits` bits in all, a multiple of 3 up to 63, on the grid of MortonGrid in normalised
// space. Throws std::length_error for more than 2^31 triangles.
MortonLeaves make_morton_leaves(std::span<const Triangle> triangles, std::uint32_t morton_bits,
                                const Threads& threads);

}  // namespace coppice
