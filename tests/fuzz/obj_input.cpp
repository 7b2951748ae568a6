#include "fuzz/obj_input.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "scene/bounds.h"
#include "scene/input_error.h"
#include "scene/load_obj.h"

namespace coppice {
namespace {

bool is_one_line(const std::string& text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
}

bool is_sound(const Material& material) {
  return is_finite(material.diffuse) && is_finite(material.specular) && is_finite(material.emission) &&
         std::isfinite(material.shininess) && std::isfinite(material.index_of_refraction) &&
         material.opacity >= 0 && material.opacity <= 1;
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

// The scene, or the message of the InputError.
struct Outcome {
  Scene scene;
  std::string message;
};

Outcome read(std::string_view obj, const std::string& mtl, const ObjReading& reading) {
  const auto find_mtl = [&](const std::string& name, MtlMatch) -> std::optional<FoundMtl> {
    if (name.starts_with("missing")) return std::nullopt;
    return FoundMtl{name, mtl};
  };
  try {
    return {parse_obj(obj, "fuzz.obj", find_mtl, reading), ""};
  } catch (const InputError& error) {
    return {{}, error.what()};
  }
}

bool is_same(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  const auto is_same_bits = [](glm::vec3 p, glm::vec3 q) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool are_nan = std::isnan(p[axis]) && std::isnan(q[axis]);
      if (!are_nan && std::bit_cast<std::uint32_t>(p[axis]) != std::bit_cast<std::uint32_t>(q[axis])) {
        return false;
      }
    }
    return true;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same_bits);
}

std::string difference(const Outcome& a, const Outcome& b) {
  if (a.message != b.message) return "messages '" + a.message + "' and '" + b.message + "'";
  if (!is_same(a.scene.positions, b.scene.positions)) return "positions";
  if (a.scene.indices != b.scene.indices) return "triangles";
  if (a.scene.material_index != b.scene.material_index) return "material indices";
  if (a.scene.materials != b.scene.materials) return "materials";
  if (a.scene.warnings != b.scene.warnings) return "warnings";
  return "";
}

}  // namespace

std::string complaint_about_obj(std::string_view input) {
  constexpr std::string_view separator = "\n===\n";
  const std::size_t end = input.find(separator);
  const std::string_view obj = input.substr(0, end);
  const std::string mtl(end == input.npos ? "" : input.substr(end + separator.size()));
  try {
    const Outcome outcome = read(obj, mtl, {});
    const std::string& message = outcome.message;
    if (!message.empty() && (!is_one_line(message) || !message.starts_with("fuzz.obj:"))) {
      return "message '" + message + "'";
    }
    // Readers must agree: both in the smallest parts, the parser of record on the whole too.
    struct Other {
      const char* name;
      std::size_t part_bytes;
      bool plain;
    };
    constexpr Other others[] = {{"in parts of one line", 1, true},
                                {"by the parser of record in parts of some lines", 40, false},
                                {"by the parser of record", std::size_t{1} << 20, false}};
    for (const auto& [name, part_bytes, plain] : others) {
      const ObjReading reading = {.part_bytes = part_bytes, .plain = plain, .progress = {}};
      const std::string differ = difference(outcome, read(obj, mtl, reading));
      if (!differ.empty()) return std::string("read differently ") + name + ": " + differ;
    }
    return message.empty() ? complaint_about(outcome.scene) : "";
  } catch (const std::exception& error) {
    return std::string("exception ") + error.what();
  }
}

}  // namespace coppice
