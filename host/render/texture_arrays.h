#pragma once

#include <string>
#include <vector>

#include "interface/texture.h"
#include "scene/scene.h"

namespace coppice {

// A scene's textures as the stages take them (interface/texture.h). Made only where something asks for them:
// this is what opens and decodes images.
struct TextureArrays {
  std::vector<TextureHeader> headers;
  std::vector<uint> texels;
  std::vector<float> srgb_to_linear;        // 256
  std::vector<MaterialTextures> materials;  // one a material of the scene
  std::vector<std::string> warnings;        // a line for each image that is missing or broken

  bool empty() const { return headers.empty(); }
};

TextureArrays texture_arrays(const Scene& scene);

// One a triangle, in the scene's order.
std::vector<CornerAttributes> corner_attributes(const Scene& scene);

// Without what a device could take for 0, alone or in a product.
vec2 without_tiny(vec2 v);

// Of TextureHeader::flags those that say how a map wraps.
uint wrap_flags(const TextureMap& map);

// Which channel of an image is opacity: CHANNEL_, or 0 to 2.
uint opacity_channel(const TextureMap& map, bool has_alpha);

}  // namespace coppice
