#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace coppice {

inline std::string base64(const std::string& bytes) {
  const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : letters[word >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

inline std::string little_endian(std::uint32_t word) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> (8 * i));
  return bytes;
}

// A glTF file in the making: `json` is free to be changed, the bytes of accessors gather in one buffer.
struct GltfText {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  std::string bytes;

  template <class T>
  int view(const std::vector<T>& values) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const std::size_t offset = bytes.size();
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  int accessor(nlohmann::json accessor) {
    json["accessors"].push_back(std::move(accessor));
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int floats(const char* type, const std::vector<float>& values) {
    const std::string name = type;
    const std::size_t width = name == "SCALAR" ? 1
                              : name == "MAT4" ? 16
                                               : static_cast<std::size_t>(name[3] - '0');
    return accessor({{"bufferView", view(values)},
                     {"componentType", 5126},
                     {"count", values.size() / width},
                     {"type", type}});
  }
  int shorts(const char* type, const std::vector<std::uint16_t>& values) {
    const std::size_t width = std::string(type) == "SCALAR" ? 1 : 4;
    return accessor({{"bufferView", view(values)},
                     {"componentType", 5123},
                     {"count", values.size() / width},
                     {"type", type}});
  }

  std::string embedded() {
    if (!bytes.empty()) {
      json["buffers"] = {
          {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    }
    return json.dump();
  }
  std::string binary() {
    json["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string text = json.dump(), padded = bytes;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    padded.resize((padded.size() + 3) / 4 * 4);
    const std::string chunks = little_endian(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
                               little_endian(static_cast<std::uint32_t>(padded.size())) +
                               std::string("BIN\0", 4) + padded;
    return "glTF" + little_endian(2) + little_endian(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
  }
};

// One node with one triangle, of accessor 0 (indices) and 1 (positions).
inline GltfText gltf_triangle() {
  GltfText text;
  text.shorts("SCALAR", {0, 1, 2});
  text.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  text.json["nodes"] = {{{"mesh", 0}}};
  text.json["meshes"] = {{{"primitives", {{{"indices", 0}, {"attributes", {{"POSITION", 1}}}}}}}};
  return text;
}

}  // namespace coppice
