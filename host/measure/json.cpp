#include "measure/json.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "scene/write_file.h"

namespace coppice {

Json coordinates(glm::dvec3 point) { return {point.x, point.y, point.z}; }

void write_json(const std::string& path, const Json& json) {
  if (path.empty()) return;
  // Names of files and devices need not be UTF-8, JSON must be: what is none becomes U+FFFD.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (path == "-") {
    std::fputs(text.c_str(), stdout);  // main says it if that fails
  } else {
    write_file(path, text);
  }
}

}  // namespace coppice
