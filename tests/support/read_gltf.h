#pragma once

#include <string>

#include "scene/input_error.h"
#include "scene/load_gltf.h"

namespace coppice {

inline Scene read_gltf(const std::string& text, const GltfReading& reading = {}) {
  return parse_gltf(
      text, "t.gltf", [](const std::string&) -> std::string { throw InputError("no such file"); }, reading);
}

inline std::string gltf_error_of(const std::string& text, const GltfReading& reading = {}) {
  try {
    read_gltf(text, reading);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace coppice
