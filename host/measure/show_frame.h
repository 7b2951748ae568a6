#pragma once

#include <optional>
#include <string>

#include "measure/json.h"
#include "measure/measure_frame.h"
#include "render/frame.h"
#include "render/show.h"

namespace coppice {

// The tree that is shown, as it came out.
struct ShownTree {
  std::span<const Node> nodes;
  std::span<const PlocRound> rounds;  // of a build that has some
};

// The word of each primitive that the view reads; empty for a view that reads none. `morton_bits`: of the
// order that is shown.
std::vector<uint> shown_values(const ShowOptions& options, std::span<const Triangle> triangles,
                               std::uint32_t morton_bits, const ShownTree& tree);

// Triangles that have these boxes, as what is shown of primitives takes them.
std::vector<Triangle> corners_of(std::span<const Aabb> boxes);

// How many different words of active primitives there are.
std::uint64_t count_groups(std::span<const uint> groups, std::span<const Node> nodes);

Json to_json(const ShownReport& shown, const Scene& scene);
std::string text_of(const ShownReport& shown, const Scene& scene);

}  // namespace coppice
