#include "scene/load_gltf.h"

#include "scene/gltf_document.h"
#include "scene/gltf_flatten.h"
#include "scene/input_error.h"
#include "scene/material_maps.h"
#include "scene/obj_file.h"
#include "scene/obj_offset.h"
#include "scene/printable.h"

namespace coppice {

Scene parse_gltf(std::string_view text, const std::string& name, const FindBytes& find,
                 const GltfReading& reading) {
  const GltfDocument document = read_gltf_document(text, name, find);
  Scene scene = flatten_gltf(document, reading.animation, glm::dvec3{0});
  if (!document.model.skins.empty() || !document.model.animations.empty()) return scene;
  const glm::dvec3 offset = find_offset(scene);
  if (offset == glm::dvec3{0}) return scene;
  scene = flatten_gltf(document, reading.animation, offset);
  scene.warnings.push_back(name + ": " + describe_offset(offset));
  return scene;
}

Scene load_gltf(const std::filesystem::path& path, const GltfReading& reading) {
  const ObjFile file = read_obj_file(path);
  const auto find = [&](const std::string& uri) {
    return std::string(read_obj_file(path.parent_path() / uri).text());
  };
  Scene scene = parse_gltf(file.text(), printable(path), find, reading);
  for (Material& material : scene.materials) lead_maps_from(material, path.parent_path());
  scene.name = printable(path.stem());
  return scene;
}

}  // namespace coppice
