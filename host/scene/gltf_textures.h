#pragma once

#include <map>
#include <memory>
#include <string>

#include "scene/gltf_document.h"
#include "scene/scene_notes.h"
#include "scene/texture_map.h"

namespace coppice {

// The textures that a document's materials name.
class GltfTextures {
 public:
  GltfTextures(const GltfDocument& document, SceneNotes& notes) : document_(document), notes_(notes) {}

  // Of a textureInfo at `pointer`: its image, wrap modes and KHR_texture_transform. No map where it needs
  // other coordinates than TEXCOORD_0 (noted). An embedded image that cannot be read has no bytes. Throws
  // InputError for an index out of range.
  TextureMap read(const nlohmann::json& texture, const std::string& pointer);

 private:
  void read_image(int image, TextureMap& map);
  void read_sampler(const nlohmann::json& texture, const std::string& pointer, TextureMap& map) const;
  std::size_t size(const char* key) const {
    return document_.json.contains(key) ? document_.json[key].size() : 0;
  }

  const GltfDocument& document_;
  SceneNotes& notes_;
  std::map<int, std::shared_ptr<const std::string>> embedded_;  // by image: each is kept once
};

}  // namespace coppice
