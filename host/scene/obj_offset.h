#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "scene/scene.h"

namespace coppice {

// What is to be subtracted from all coordinates, as they were before float rounded them, so that float holds
// the details of a scene that is far from the origin for its size: 0 unless the largest coordinate of the
// visible triangles is more than FAR times the longest side of their box. Else their centre, each coordinate
// rounded to a multiple of a power of two not less than that side, which leaves coordinates that are near 0
// as they are.
//
// The positions may be rounded, even so that no triangle has an area: then the result is near enough that
// once it has been subtracted another call finds what is left.
inline constexpr double FAR = 16;  // float then tells 2^20 places apart on that side
glm::dvec3 find_offset(const Scene& scene);

// What a user is told of it.
std::string describe_offset(glm::dvec3 offset);

}  // namespace coppice
