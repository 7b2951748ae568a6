#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace coppice {

// What a reader must not have made of any input, empty where there is nothing to complain of: an index out of
// range, counts that do not fit, a camera or material that is not finite, a warning that is not one line of
// printable text, positions that are not those of the motion at second 0.
std::string complaint_about(const Scene& scene);

bool is_one_line(const std::string& text);

// Bit for bit, but for the bits of NaN.
bool is_same(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b);

}  // namespace coppice
