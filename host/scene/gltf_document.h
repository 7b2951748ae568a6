#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scene/load_gltf.h"

namespace coppice {

// A glTF 2.0 file that has passed its schema, with the contents of its buffers. What indices refer to is not
// yet checked. Images, textures and samplers are left out of the model; they are in `json`.
struct GltfDocument {
  std::string name;  // begins messages
  nlohmann::json json;
  tinygltf::Model model;  // arrays in the order of the file's
  std::size_t bytes = 0;  // of the file and its buffers: a measure for what it may ask for

  // The bytes of a buffer view, or of a base64 data URI at `pointer`. Throw InputError.
  std::string bytes_of_view(int view, const std::string& user) const;
  std::string bytes_of_data_uri(const std::string& uri, const std::string& pointer) const;

  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const;
  // Fails unless 0 <= index < count; `of` names what is counted.
  void check_index(const std::string& pointer, int index, std::size_t count, const char* of) const;
};

// A URI's text with the bytes that %XX stand for.
std::string percent_decoded(std::string_view uri);

// `text` is a .gltf or a .glb, told apart by the first bytes. Throws InputError "NAME: POINTER: WHAT".
GltfDocument read_gltf_document(std::string_view text, const std::string& name, const FindBytes& find);

}  // namespace coppice
