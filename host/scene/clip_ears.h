#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace coppice {

// Cuts a closed outline into triangles by cutting off ears, exactly outline.size() - 2 of them, indices into
// `outline`, which must have at least three corners, all finite. True where none of them turns to the right,
// exactly: then they cover each point as often as the outline winds around it. Finds such a cut for every
// outline that does not touch itself, unless the search takes too long: it looks at no more than a
// multiple of the number of corners; what is then left becomes a fan.
bool clip_ears(std::span<const glm::vec2> outline, std::vector<glm::uvec3>& triangles);

}  // namespace coppice
