#include "fuzz/obj_input.h"

#include <algorithm>
#include <cmath>

#include "scene/input_error.h"
#include "scene/load_obj.h"

namespace coppice {
namespace {

bool is_one_line(const std::string& text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
}

bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_sound(const Material& material) {
  return is_finite(material.ambient) && is_finite(material.diffuse) && is_finite(material.specular) &&
         is_finite(material.emission) && std::isfinite(material.shininess) &&
         std::isfinite(material.index_of_refraction) && material.opacity >= 0 && material.opacity <= 1;
}

std::string complaint_about(const Scene& scene) {
  for (const glm::uvec3 triangle : scene.indices) {
    if (std::max({triangle.x, triangle.y, triangle.z}) >= scene.positions.size()) return "vertex index";
  }
  if (scene.material_index.size() != scene.indices.size()) return "count of material indices";
  for (const std::uint32_t index : scene.material_index) {
    if (index >= scene.materials.size()) return "material index";
  }
  if (scene.materials.empty()) return "no material";
  for (const Material& material : scene.materials) {
    if (!is_sound(material)) return "material '" + material.name + "'";
  }
  for (const std::string& warning : scene.warnings) {
    if (!is_one_line(warning)) return "warning '" + warning + "'";
  }
  const Camera camera = frame_scene(scene, 1.5f);
  if (!is_finite(camera.position) || !is_finite(camera.target) || !is_finite(camera.up)) return "camera";
  return "";
}

}  // namespace

std::string complaint_about_obj(std::string_view input) {
  constexpr std::string_view separator = "\n===\n";
  const std::size_t end = input.find(separator);
  const std::string obj(input.substr(0, end));
  const std::string mtl(end == input.npos ? "" : input.substr(end + separator.size()));
  try {
    return complaint_about(
        parse_obj(obj, "fuzz.obj", [&](const std::string& name) -> std::optional<std::string> {
          if (name.starts_with("missing")) return std::nullopt;
          return mtl;
        }));
  } catch (const InputError& error) {
    const std::string what = error.what();
    return is_one_line(what) && what.starts_with("fuzz.obj:") ? "" : "message '" + what + "'";
  } catch (const std::exception& error) {
    return std::string("exception ") + error.what();
  }
}

}  // namespace coppice
