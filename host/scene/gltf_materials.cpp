#include "scene/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "scene/gltf_textures.h"

namespace coppice {
namespace {

using nlohmann::json;

glm::vec3 colour_of(const json& numbers) {
  return {numbers[0].get<float>(), numbers[1].get<float>(), numbers[2].get<float>()};
}

// The exponent whose highlight is as wide as that of a microfacet surface (Walter 2007: alpha = roughness^2).
float shininess_of(float roughness) {
  const float alpha = std::max(roughness * roughness, 0.01f);
  return std::clamp(2.0f / (alpha * alpha) - 2.0f, 0.0f, 1000.0f);
}

void read_maps(GltfTextures& textures, const json& from, const json& surface, const std::string& pointer,
               Material& material) {
  material.roughness = surface.value("roughnessFactor", 1.0f);
  material.metallic = surface.value("metallicFactor", 1.0f);
  const auto map_of = [&](const json& parent, const char* key, const std::string& step) {
    return parent.contains(key) ? textures.read(parent[key], pointer + step + key) : TextureMap{};
  };
  material.diffuse_map = map_of(surface, "baseColorTexture", "/pbrMetallicRoughness/");
  material.emission_map = map_of(from, "emissiveTexture", "/");
  material.normal_map = map_of(from, "normalTexture", "/");
  if (material.normal_map) material.normal_map.strength = from["normalTexture"].value("scale", 1.0f);
  const TextureMap both = map_of(surface, "metallicRoughnessTexture", "/pbrMetallicRoughness/");
  if (!both) return;
  material.roughness_map = material.metallic_map = both;
  material.roughness_map.channel = 'g';
  material.metallic_map.channel = 'b';
}

Material material_of(const GltfDocument& document, std::size_t index, GltfTextures& textures) {
  const json& from = document.json["materials"][index];
  const std::string pointer = "/materials/" + std::to_string(index);
  const json surface = from.value("pbrMetallicRoughness", json::object());
  const json extensions = from.value("extensions", json::object());
  const json base = surface.value("baseColorFactor", json::array({1, 1, 1, 1}));
  const float metallic = surface.value("metallicFactor", 1.0f);

  Material material;
  material.name = from.value("name", "material " + std::to_string(index));
  material.diffuse = colour_of(base);
  material.filter = glm::clamp(material.diffuse, 0.0f, 1.0f);
  material.specular = glm::mix(glm::vec3(0.04f), material.diffuse, metallic);
  material.shininess = shininess_of(surface.value("roughnessFactor", 1.0f));
  material.index_of_refraction = 1.5f;
  material.illum = metallic > 0.5f ? 3 : 2;
  read_maps(textures, from, surface, pointer, material);
  if (from.contains("emissiveFactor")) material.emission = colour_of(from["emissiveFactor"]);

  const std::string alpha_mode = from.value("alphaMode", "OPAQUE");
  const float alpha = base[3].get<float>();
  if (alpha_mode == "BLEND") material.opacity = alpha;
  const float cutoff = from.value("alphaCutoff", 0.5f);
  if (alpha_mode == "MASK") material.opacity = alpha >= cutoff ? 1.0f : 0.0f;
  if (alpha_mode != "OPAQUE" && material.diffuse_map) {
    material.opacity_map = material.diffuse_map;
    material.opacity_map.channel = 'm';
    // The map's alpha is multiplied by the factor before it is compared.
    if (alpha_mode == "MASK" && alpha > 0) material.alpha_cutoff = cutoff / alpha;
  }

  const auto extension = [&](const char* name) { return extensions.value(name, json::object()); };
  material.emission *= extension("KHR_materials_emissive_strength").value("emissiveStrength", 1.0f);
  material.index_of_refraction = extension("KHR_materials_ior").value("ior", 1.5f);
  const float transmission = extension("KHR_materials_transmission").value("transmissionFactor", 0.0f);
  if (transmission > 0) {
    material.opacity *= 1 - transmission;
    material.illum = 7;
  }
  if (extensions.contains("KHR_materials_unlit")) {
    material.emission = material.diffuse;
    material.emission_map = std::exchange(material.diffuse_map, {});
    material.diffuse = material.specular = glm::vec3(0);
    material.illum = 0;
    material.is_unlit = true;
  }
  return material;
}

}  // namespace

std::vector<Material> read_gltf_materials(const GltfDocument& document, SceneNotes& notes) {
  std::vector<Material> materials = {Material{}};
  GltfTextures textures(document, notes);
  const std::size_t count = document.json.contains("materials") ? document.json["materials"].size() : 0;
  for (std::size_t i = 0; i < count; ++i) materials.push_back(material_of(document, i, textures));
  return materials;
}

}  // namespace coppice
