#include "scene/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace coppice {
namespace {

using nlohmann::json;

glm::vec3 colour_of(const json& numbers) {
  return {numbers[0].get<float>(), numbers[1].get<float>(), numbers[2].get<float>()};
}

// The file of a texture's image; empty where it is embedded.
std::string map_of(const GltfDocument& document, const json& texture, const std::string& pointer) {
  const json& all = document.json;
  const auto size = [&](const char* key) { return all.contains(key) ? all[key].size() : 0; };
  const int index = texture["index"].get<int>();
  document.check_index(pointer + "/index", index, size("textures"), "textures");
  const json& source = all["textures"][static_cast<std::size_t>(index)];
  if (!source.contains("source")) return "";
  const int image = source["source"].get<int>();
  document.check_index("/textures/" + std::to_string(index) + "/source", image, size("images"), "images");
  const std::string uri = all["images"][static_cast<std::size_t>(image)].value("uri", "");
  return uri.starts_with("data:") ? "" : uri;
}

// The exponent whose highlight is as wide as that of a microfacet surface (Walter 2007: alpha = roughness^2).
float shininess_of(float roughness) {
  const float alpha = std::max(roughness * roughness, 0.01f);
  return std::clamp(2.0f / (alpha * alpha) - 2.0f, 0.0f, 1000.0f);
}

Material material_of(const GltfDocument& document, std::size_t index) {
  const json& from = document.json["materials"][index];
  const std::string pointer = "/materials/" + std::to_string(index);
  const json surface = from.value("pbrMetallicRoughness", json::object());
  const json extensions = from.value("extensions", json::object());
  const json base = surface.value("baseColorFactor", json::array({1, 1, 1, 1}));
  const float metallic = surface.value("metallicFactor", 1.0f);

  Material material;
  material.name = from.value("name", "material " + std::to_string(index));
  material.diffuse = colour_of(base);
  material.specular = glm::mix(glm::vec3(0.04f), material.diffuse, metallic);
  material.shininess = shininess_of(surface.value("roughnessFactor", 1.0f));
  material.index_of_refraction = 1.5f;
  material.illum = metallic > 0.5f ? 3 : 2;
  if (surface.contains("baseColorTexture")) {
    material.diffuse_map =
        map_of(document, surface["baseColorTexture"], pointer + "/pbrMetallicRoughness/baseColorTexture");
  }
  if (from.contains("emissiveFactor")) material.emission = colour_of(from["emissiveFactor"]);

  const std::string alpha_mode = from.value("alphaMode", "OPAQUE");
  const float alpha = base[3].get<float>();
  if (alpha_mode == "BLEND") material.opacity = alpha;
  if (alpha_mode == "MASK") material.opacity = alpha >= from.value("alphaCutoff", 0.5f) ? 1.0f : 0.0f;

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
    material.diffuse = material.specular = glm::vec3(0);
    material.illum = 0;
  }
  return material;
}

}  // namespace

std::vector<Material> read_gltf_materials(const GltfDocument& document) {
  std::vector<Material> materials = {Material{}};
  const std::size_t count = document.json.contains("materials") ? document.json["materials"].size() : 0;
  for (std::size_t i = 0; i < count; ++i) materials.push_back(material_of(document, i));
  return materials;
}

}  // namespace coppice
