#pragma once

#include <glm/vec2.hpp>

namespace coppice {

// 1 where the finite points a, b, c turn left, -1 where they turn right, 0 where they are on one line. Exact.
int orientation(glm::vec2 a, glm::vec2 b, glm::vec2 c);

}  // namespace coppice
