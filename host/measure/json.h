#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace coppice {

using Json = nlohmann::ordered_json;  // declared only: its header takes seconds to compile

Json coordinates(glm::dvec3 point);

// Writes to the file, or to stdout for "-"; nothing for "". Bytes of names that are no UTF-8 become U+FFFD.
// Throws InputError naming the file.
void write_json(const std::string& path, const Json& json);

}  // namespace coppice
