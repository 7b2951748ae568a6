#include "scene/gltf_textures.h"

#include <algorithm>

#include "scene/input_error.h"

namespace coppice {
namespace {

using nlohmann::json;

// glTF 2.0, 5.26.
TextureWrap wrap_of(const json& sampler, const char* key) {
  constexpr int clamp_to_edge = 33071, mirrored_repeat = 33648;
  const int mode = sampler.value(key, 10497);
  return mode == clamp_to_edge     ? TextureWrap::clamp
         : mode == mirrored_repeat ? TextureWrap::mirror
                                   : TextureWrap::repeat;
}

glm::vec2 pair_or(const json& from, const char* key, glm::vec2 otherwise) {
  if (!from.contains(key)) return otherwise;
  constexpr float most = 0x1p20f;
  const auto number = [&](std::size_t i) { return std::clamp(from[key][i].get<float>(), -most, most); };
  return {number(0), number(1)};
}

}  // namespace

TextureMap GltfTextures::read(const json& texture, const std::string& pointer) {
  const int index = texture["index"].get<int>();
  document_.check_index(pointer + "/index", index, size("textures"), "textures");
  const json transform =
      texture.value("extensions", json::object()).value("KHR_texture_transform", json::object());
  if (transform.value("texCoord", texture.value("texCoord", 0)) != 0) {
    notes_.add(pointer + "/texCoord", "textures with other coordinates than TEXCOORD_0 are not used");
    return {};
  }
  if (transform.value("rotation", 0.0) != 0) {
    notes_.add(pointer + "/extensions/KHR_texture_transform/rotation", "textures are not rotated");
  }
  TextureMap map;
  map.scale = pair_or(transform, "scale", glm::vec2(1));
  map.offset = pair_or(transform, "offset", glm::vec2(0));
  const std::string texture_pointer = "/textures/" + std::to_string(index);
  const json& from = document_.json["textures"][static_cast<std::size_t>(index)];
  read_sampler(from, texture_pointer, map);
  if (from.contains("source")) {
    const int image = from["source"].get<int>();
    document_.check_index(texture_pointer + "/source", image, size("images"), "images");
    read_image(image, map);
  } else {
    // Of an extension, such as KHR_texture_basisu.
    map.name = texture_pointer;
    map.bytes = embedded_.try_emplace(-1, std::make_shared<const std::string>()).first->second;
  }
  return map;
}

void GltfTextures::read_image(int image, TextureMap& map) {
  const json& from = document_.json["images"][static_cast<std::size_t>(image)];
  const std::string pointer = "/images/" + std::to_string(image);
  const std::string uri = from.value("uri", "");
  if (!uri.empty() && !uri.starts_with("data:")) {
    map.name = percent_decoded(uri);
    return;
  }
  map.name = pointer;
  std::shared_ptr<const std::string>& bytes = embedded_[image];
  if (bytes) {
    map.bytes = bytes;
    return;
  }
  std::string read;
  if (from.contains("bufferView")) {
    read = document_.bytes_of_view(from["bufferView"].get<int>(), pointer + "/bufferView");
  } else if (!uri.empty()) {
    try {
      read = document_.bytes_of_data_uri(uri, pointer + "/uri");
    } catch (const InputError& error) {
      notes_.add(pointer + "/uri", "images that are no base64 are not used");
    }
  }
  map.bytes = bytes = std::make_shared<const std::string>(std::move(read));
}

void GltfTextures::read_sampler(const json& texture, const std::string& pointer, TextureMap& map) const {
  if (!texture.contains("sampler")) return;
  const int index = texture["sampler"].get<int>();
  document_.check_index(pointer + "/sampler", index, size("samplers"), "samplers");
  const json& sampler = document_.json["samplers"][static_cast<std::size_t>(index)];
  map.wrap_u = wrap_of(sampler, "wrapS");
  map.wrap_v = wrap_of(sampler, "wrapT");
}

}  // namespace coppice
