#pragma once

#include <array>
#include <filesystem>

#include "scene/scene.h"

namespace coppice {

// The maps that a material may have.
struct MaterialMap {
  TextureMap Material::*map;
  const char* name;  // in MTL
  bool is_colour;    // sRGB; else numbers as they are
};

inline constexpr std::array MATERIAL_MAPS = std::to_array<MaterialMap>({
    {&Material::diffuse_map, "map_Kd", true},
    {&Material::opacity_map, "map_d", false},
    {&Material::emission_map, "map_Ke", true},
    {&Material::bump_map, "map_Bump", false},
    {&Material::normal_map, "norm", false},
    {&Material::roughness_map, "map_Pr", false},
    {&Material::metallic_map, "map_Pm", false},
});

// Names of files lead on from `folder`, before what they lead on from now.
inline void lead_maps_from(Material& material, const std::filesystem::path& folder) {
  for (const MaterialMap& kind : MATERIAL_MAPS) {
    TextureMap& map = material.*kind.map;
    if (map && !map.bytes) map.folder = map.folder.empty() ? folder.string() : (folder / map.folder).string();
  }
}

}  // namespace coppice
