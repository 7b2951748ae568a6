#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "support/lit_scene.h"

namespace coppice {

// The bytes of a TGA file of so many pixels, 0xrrggbb, rows from the top.
inline std::string tga_of(std::uint16_t width, std::uint16_t height,
                          const std::vector<std::uint32_t>& pixels) {
  std::string bytes(18, '\0');
  bytes[2] = 2;  // colours as they are
  for (const auto& [at, side] : {std::pair{12, width}, std::pair{14, height}}) {
    bytes[static_cast<std::size_t>(at)] = static_cast<char>(side & 255);
    bytes[static_cast<std::size_t>(at) + 1] = static_cast<char>(side >> 8);
  }
  bytes[16] = 24;
  bytes[17] = 0x20;  // from the top
  for (const std::uint32_t pixel : pixels) {
    for (const int shift : {0, 8, 16}) bytes += static_cast<char>(pixel >> shift & 255);
  }
  return bytes;
}

inline TextureMap map_of(std::uint16_t width, std::uint16_t height,
                         const std::vector<std::uint32_t>& pixels) {
  TextureMap map;
  map.name = "test";
  map.bytes = std::make_shared<const std::string>(tga_of(width, height, pixels));
  map.wrap_u = map.wrap_v = TextureWrap::clamp;
  return map;
}

// Texture coordinates (0, 0) to (1, 1) on the last quad that add_quad added, u along its side b and v along
// its side a.
inline void add_texcoords(Scene& scene) {
  const auto first = static_cast<uint>(scene.texcoords.size());
  scene.texcoords.insert(scene.texcoords.end(), {{0, 0}, {0, 1}, {1, 1}, {1, 0}});
  scene.texcoord_index.resize(scene.indices.size() - 2, uvec3(~0u));
  scene.texcoord_index.push_back({first, first + 1, first + 2});
  scene.texcoord_index.push_back({first, first + 2, first + 3});
}

// A square of the plane z = 0 between (-1, -1) and (1, 1) with this map, seen from (0, 0, distance), which
// ambient light alone lights.
inline Scene textured_square(const TextureMap& map, float distance) {
  Scene scene;
  add_quad(scene, {-1, -1, 0}, {0, 2, 0}, {2, 0, 0});
  add_texcoords(scene);
  scene.materials[0].diffuse = vec3(1);
  scene.materials[0].diffuse_map = map;
  scene.light.radiance = vec3(0);
  scene.ambient_light = vec3(1);
  scene.camera = Camera{.position = {0, 0, distance}, .target = {0, 0, 0}};
  return scene;
}

// Two textured squares, of which one shines too, over random triangles without texture coordinates.
inline Scene textured_scene(std::uint32_t triangle_count) {
  Scene scene = triangles_over_plane(triangle_count);
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < 16 * 8; ++i) pixels.push_back(i * 0x050301u & 0xffffffu);
  scene.materials[0].diffuse_map = map_of(16, 8, pixels);
  scene.materials.push_back({});
  scene.materials[1].emission = vec3(0.5f);
  scene.materials[1].emission_map = map_of(2, 2, {0xff0000, 0x00ff00, 0x0000ff, 0xffffff});
  for (uint i = 0; i < 2; ++i) {
    add_quad(scene, vec3(-2 + 2.0f * static_cast<float>(i), -0.4f, 0), {0, 1.5f, 0.5f}, {1.5f, 0, 0});
    add_texcoords(scene);
    scene.material_index.back() = scene.material_index[scene.indices.size() - 2] = i;
  }
  return scene;
}

}  // namespace coppice
