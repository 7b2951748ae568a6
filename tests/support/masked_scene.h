#pragma once

#include <initializer_list>

#include "support/textured_scene.h"

namespace coppice {

// A map of opacity: a grey TGA of these codes, rows from the top.
inline TextureMap opacity_of(std::uint16_t width, std::uint16_t height,
                             const std::vector<std::uint32_t>& codes) {
  std::vector<std::uint32_t> pixels;
  for (const std::uint32_t code : codes) pixels.push_back(code * 0x010101u);
  return map_of(width, height, pixels);
}

// A square as of textured_square, white where its map of opacity says that it is there.
inline Scene masked_square(const TextureMap& opacity, std::optional<float> cutoff, float distance = 4) {
  Scene scene = textured_square({}, distance);
  scene.materials[0].opacity_map = opacity;
  scene.materials[0].alpha_cutoff = cutoff;
  return scene;
}

// All kinds at once: a mask and coverage on textured squares, coverage without an image and nothing at all
// among random triangles that are solid.
inline Scene masked_scene(std::uint32_t triangle_count) {
  Scene scene = textured_scene(triangle_count);
  scene.materials[0].opacity_map = opacity_of(4, 3, {255, 0, 200, 30, 90, 160, 0, 255, 255, 128, 127, 0});
  scene.materials[0].opacity_map.wrap_u = TextureWrap::repeat;
  scene.materials[0].opacity_map.scale = {2.5f, 1.5f};
  scene.materials[0].alpha_cutoff = 0.5f;
  scene.materials[1].opacity_map = opacity_of(3, 2, {0, 255, 128, 255, 64, 0});
  scene.materials[1].opacity_map.wrap_v = TextureWrap::mirror;
  scene.materials[1].opacity = 0.75f;
  Material half, none;
  half.opacity = 0.5f;
  none.opacity = 0;
  scene.materials.push_back(half);
  scene.materials.push_back(none);
  for (std::size_t i = 2; i + 4 < scene.material_index.size(); ++i) {
    if (i % 3 == 0) scene.material_index[i] = 2;
    if (i % 7 == 0) scene.material_index[i] = 3;
  }
  return scene;
}

}  // namespace coppice
