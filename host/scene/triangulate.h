#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace coppice {

// Appends the triangles of a polygon, exactly polygon.size() - 2 of them, each with the polygon's winding.
// `polygon` holds at least three indices into `positions`. Convex polygons become fans; others are cut by ear
// clipping, in the plane that fits them best. Polygons that have no such cut (self-intersecting, flat,
// non-finite) still give all their triangles. Takes linear time, but for concave polygons of up to
// MAX_EAR_CLIPPED corners; larger concave ones become fans too.
void triangulate(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<glm::uvec3>& triangles);

inline constexpr std::size_t MAX_EAR_CLIPPED = 1024;

}  // namespace coppice
