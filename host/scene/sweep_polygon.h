#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace coppice {

// Cuts the area around which a closed outline winds into triangles, in n log n time with exact predicates.
// The outline may touch itself: corners and edges may coincide, also in part, a corner may stand on an edge,
// and edges may go out and back. Appends triangles as indices into `outline`, each with an area, each point
// covered once, however often the outline winds around it. They run to the left where it winds to the left,
// else to the right. False, with what has been appended of no use, where edges cross between their ends. All
// coordinates must be finite.
bool sweep_polygon(std::span<const glm::vec2> outline, std::vector<glm::uvec3>& triangles);

}  // namespace coppice
