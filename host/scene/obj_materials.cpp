#include "scene/obj_materials.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scene/printable.h"

namespace coppice {
namespace {

constexpr std::size_t MAX_WARNINGS = 20;

float finite_or(float value, float otherwise) { return std::isfinite(value) ? value : otherwise; }

glm::vec3 to_colour(const tinyobj::real_t (&rgb)[3]) {
  return {finite_or(rgb[0], 0), finite_or(rgb[1], 0), finite_or(rgb[2], 0)};
}

Material to_material(const tinyobj::material_t& mtl) {
  Material material;
  material.name = mtl.name;
  material.ambient = to_colour(mtl.ambient);
  material.diffuse = to_colour(mtl.diffuse);
  material.specular = to_colour(mtl.specular);
  material.emission = to_colour(mtl.emission);
  material.shininess = finite_or(mtl.shininess, 1);
  material.opacity = std::clamp(finite_or(mtl.dissolve, 1), 0.0f, 1.0f);
  material.index_of_refraction = finite_or(mtl.ior, 1);
  material.illum = mtl.illum;
  material.diffuse_map = mtl.diffuse_texname;
  // Most files that light by textures or path tracing leave Ka out or black, and would be black in every
  // shadow.
  if (material.ambient == glm::vec3{0}) material.ambient = material.diffuse;
  return material;
}

// tinyobjloader overflows an int on exponents of ten digits. Eight are far beyond what a float holds. The
// rest of such a word goes too, as tinyobjloader passes over what follows a number. Lines that name a
// material stay.
void shorten_exponents(std::string& text) {
  constexpr std::size_t kept = 8;
  constexpr const char* blanks = " \t\r\n";
  bool names_material = false;
  std::size_t end = 0;
  for (std::size_t begin; (begin = text.find_first_not_of(blanks, end)) < text.size();) {
    const std::string_view gap = std::string_view(text).substr(end, begin - end);
    const bool begins_line = end == 0 || gap.find_first_of("\r\n") != gap.npos;
    end = std::min(text.find_first_of(blanks, begin), text.size());
    const std::string_view word = std::string_view(text).substr(begin, end - begin);
    if (begins_line) names_material = word == "newmtl";
    const std::size_t e = word.find_first_not_of("+-.0123456789");
    if (names_material || e == 0 || e >= word.size() || (word[e] != 'e' && word[e] != 'E')) continue;
    const std::size_t first = std::min(word.find_first_not_of("+-0", e + 1), word.size());
    const std::size_t last = std::min(word.find_first_not_of("0123456789", first), word.size());
    if (last - first > kept) std::fill(text.begin() + begin + first + kept, text.begin() + end, ' ');
  }
}

}  // namespace

ObjMaterials::ObjMaterials(ReadMtl read, std::vector<std::string>& warnings)
    : read_(std::move(read)), warnings_(warnings) {}

bool ObjMaterials::operator()(const std::string& name, std::vector<tinyobj::material_t>*,
                              std::map<std::string, int>*, std::string*, std::string*) {
  // Always false, which says "not found": else tinyobjloader would not ask for the other files of the same
  // line.
  constexpr bool ask_for_the_next = false;

  std::optional<std::string> text = read_(name);
  if (!text) {
    warn("material file '" + printable(std::string_view(name)) + "' not found");
    return ask_for_the_next;
  }

  std::vector<tinyobj::material_t> read;
  std::map<std::string, int> ignored_map;
  std::string mtl_warnings, ignored_error;
  shorten_exponents(*text);
  std::istringstream file(std::move(*text));
  tinyobj::LoadMtl(&ignored_map, &read, &file, &mtl_warnings, &ignored_error);
  std::size_t count = 0;
  for (const tinyobj::material_t& mtl : read) {
    if (mtl.name.empty()) continue;  // what stood before the first newmtl
    ++count;
    if (!index_of_.try_emplace(mtl.name, static_cast<std::uint32_t>(materials_.size())).second) continue;
    materials_.push_back(to_material(mtl));
  }
  if (count == 0) warn("no material in '" + printable(std::string_view(name)) + "'");
  std::istringstream lines(mtl_warnings);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty())
      warn("'" + printable(std::string_view(name)) + "': " + printable(std::string_view(line)));
  }
  return ask_for_the_next;
}

std::uint32_t ObjMaterials::find(std::string name) {
  name.erase(name.find_last_not_of(" \t") + 1);
  const auto [entry, is_new] = index_of_.try_emplace(name, 0);
  if (is_new) warn("material '" + printable(std::string_view(name)) + "' not found, default used");
  return entry->second;
}

void ObjMaterials::warn(std::string line) {
  if (warnings_.size() == MAX_WARNINGS) line = "more about materials, not shown";
  if (warnings_.size() > MAX_WARNINGS) return;
  if (std::find(warnings_.begin(), warnings_.end(), line) == warnings_.end()) {
    warnings_.push_back(std::move(line));
  }
}

}  // namespace coppice
