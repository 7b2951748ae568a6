#include "fuzz/obj_input.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "fuzz/scene_complaint.h"
#include "scene/input_error.h"
#include "scene/load_obj.h"

namespace coppice {
namespace {

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

std::string difference(const Outcome& a, const Outcome& b) {
  if (a.message != b.message) return "messages '" + a.message + "' and '" + b.message + "'";
  if (!is_same(a.scene.positions, b.scene.positions)) return "positions";
  if (a.scene.indices != b.scene.indices) return "triangles";
  if (a.scene.material_index != b.scene.material_index) return "material indices";
  if (a.scene.texcoord_index != b.scene.texcoord_index || a.scene.normal_index != b.scene.normal_index)
    return "corner attributes";
  if (!is_same(a.scene.normals, b.scene.normals)) return "normals";
  if (!std::ranges::equal(a.scene.texcoords, b.scene.texcoords,
                          [](glm::vec2 x, glm::vec2 y) { return std::memcmp(&x, &y, sizeof x) == 0; })) {
    return "texture coordinates";
  }
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
