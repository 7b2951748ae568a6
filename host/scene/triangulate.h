#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace coppice {

// Appends the triangles of a polygon, exactly polygon.size() - 2 of them, all of corners of the polygon.
// `polygon` holds at least three indices into `positions`. All that follows is meant on the two axes on which
// the polygon's area is largest, and is exact there.
//
// A polygon whose edges do not cross is covered, each point as often as the polygon winds around it, and true
// is returned. It may be concave, and it may touch itself: corners and edges may coincide, a corner may stand
// on an edge, edges may go out and back (spikes, bridges to holes). The triangles have the polygon's winding,
// but where it touches itself so that it winds the other way round a part, as an 8 with a corner in its
// middle does, those of that part have the other one. Triangles without area make up the number. Convex
// polygons become fans from their first corner. Takes n log n time.
//
// False where no such cut was found: edges cross, or the polygon winds around some points more than once.
// Then the triangles show it as well as a search of bounded length can; some may overlap or reach outside.
// What this concerns less than a millionth of the area, as after rounding, is no reason for false.
//
// A polygon with a corner that is not finite becomes triangles that all have that corner; true is returned.
bool triangulate(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<glm::uvec3>& triangles);

}  // namespace coppice
