#pragma once

#include <cstdint>
#include <variant>

#include "interface/types.h"
#include "stages/chain.h"
#include "stages/layout.h"

namespace coppice {

// What a tree is built over.
enum class PrimitiveKind { triangles, boxes };

// Triangles that lie in the plan's slot.
struct PackedTriangles {};

// Triangles as others keep them, which the plan's slot takes up. One with an index out of range, or a corner
// that is not finite (once transformed), is inactive.
struct VertexTriangles {
  UintBuffer vertices{};   // three floats at the start of each vertex_stride bytes; a multiple of 4
  UintBuffer indices{};    // a multiple of index_bytes; null: corner k of triangle i is vertex 3 i + k
  UintBuffer transform{};  // three rows of four floats, a multiple of 4; null: none
  std::uint32_t vertex_count = 0;
  std::uint32_t vertex_stride = 3 * sizeof(float);  // a multiple of 4
  std::uint32_t first_vertex = 0;                   // added to each index
  std::uint32_t index_bytes =
      4;  // or 2: then words of 4 bytes are read that hold an index, from multiples of 4
};

// Boxes of primitives that only the caller knows. One that is not finite, or whose minimum is above its
// maximum, is inactive.
struct GivenBoxes {
  UintBuffer boxes{};                   // an Aabb at the start of each stride bytes; a multiple of 4
  std::uint32_t stride = sizeof(Aabb);  // a multiple of 4
};

// What a build reads.
struct BuildInput {
  std::variant<PackedTriangles, VertexTriangles, GivenBoxes> primitives{};
  // Null: as many primitives as the build was planned for. Or where the device has their number, of which at
  // most those count; more are ERROR_COUNT, and BuildState::primitive_count says how many.
  UintBuffer count_at{};
};

// Where a plan keeps primitives.
struct PrimitiveSlots {
  std::uint32_t count = 0;
  Slot<Triangle> triangles;  // none of boxes
  Slot<Aabb> boxes;
  Slot<BuildState> state;
};

// For so many primitives. Throws LayoutError if a slot does not fit a block.
PrimitiveSlots plan_primitives(Layout& layout, std::uint32_t count, PrimitiveKind kind);

// Workgroups for at most `count` items, `size` to each: at least one where the device has their number, to
// say that it is too large.
uvec3 counted_groups(std::uint32_t count, std::uint32_t size, UintBuffer count_at);

// Others' triangles into a slot of so many. Throws std::invalid_argument as append_primitives.
void append_triangles(Chain& chain, const Slot<Triangle>& triangles, const VertexTriangles& input,
                      UintBuffer count_at = {});

// To boxes, the scene's box and the number of active primitives. Throws std::invalid_argument for addresses
// and strides that no kernel reads, and for triangles where boxes were planned or the other way round.
void append_primitives(Chain& chain, const PrimitiveSlots& slots, const BuildInput& input);

}  // namespace coppice
