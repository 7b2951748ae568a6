#include "scene/obj_mtl.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>

#include "scene/material_maps.h"
#include "scene/obj_lines.h"
#include "scene/obj_mtl_maps.h"
#include "scene/printable.h"

namespace coppice {
namespace {

// The statements that are read, spelt as tinyobjloader knows them.
constexpr std::array KEYWORDS = std::to_array<std::string_view>(
    {"newmtl", "Ka", "Kd", "Ks", "Ke", "Kt", "Tf", "Ns", "Ni", "d", "Tr", "illum", "Pr", "Pm"});

// Of a keyword in lower case; none for others.
const MaterialMap* find_map(std::string_view keyword) {
  if (keyword == "bump") keyword = "map_bump";
  if (keyword == "map_kn") keyword = "norm";
  const auto found = std::ranges::find_if(
      MATERIAL_MAPS, [&](const MaterialMap& kind) { return lower_case(kind.name) == keyword; });
  return found == MATERIAL_MAPS.end() ? nullptr : &*found;
}

std::string_view usual_spelling(std::string_view keyword) {
  const std::string lower = lower_case(keyword);
  if (const MaterialMap* const kind = find_map(lower)) return kind->name;
  const auto found =
      std::find_if(KEYWORDS.begin(), KEYWORDS.end(), [&](auto known) { return lower_case(known) == lower; });
  return found == KEYWORDS.end() ? keyword : *found;
}

bool is_colour(std::string_view keyword) {
  return keyword.size() == 2 && (keyword[0] == 'K' || keyword == "Tf");
}

bool looks_like_number(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  return !word.empty() && (word[0] == '.' || (word[0] >= '0' && word[0] <= '9'));
}

// Whether all of a word is a number. One beyond the range of float is.
bool is_number(std::string_view word) {
  if (!looks_like_number(word)) return false;
  if (word.starts_with('+')) word.remove_prefix(1);
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return end == word.data() + word.size() && error != std::errc::invalid_argument;
}

// The words of a line before a comment.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  Words rest(line);
  for (std::string_view word = rest.next(); !word.empty() && word[0] != '#'; word = rest.next()) {
    words.push_back(word);
  }
  return words;
}

// tinyobjloader overflows an int on exponents of ten digits. Eight are far beyond what a float holds. The
// rest of such a word goes too, as tinyobjloader passes over what follows a number.
std::string shorten_exponent(std::string_view word) {
  constexpr std::size_t kept = 8;
  const std::size_t e = word.find_first_not_of("+-.0123456789");
  if (e == 0 || e >= word.size() || (word[e] != 'e' && word[e] != 'E')) return std::string(word);
  const std::size_t first = std::min(word.find_first_not_of("+-0", e + 1), word.size());
  const std::size_t last = std::min(word.find_first_not_of("0123456789", first), word.size());
  return std::string(last - first > kept ? word.substr(0, first + kept) : word);
}

float finite_or(float value, float otherwise) { return std::isfinite(value) ? value : otherwise; }

glm::vec3 to_colour(const tinyobj::real_t (&rgb)[3]) {
  return {finite_or(rgb[0], 0), finite_or(rgb[1], 0), finite_or(rgb[2], 0)};
}

// CIE XYZ to linear RGB with the primaries and the white of sRGB.
glm::vec3 xyz_to_rgb(glm::vec3 xyz) {
  const glm::vec3 rgb = {3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
                         -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
                         0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z};
  return {finite_or(std::max(rgb.x, 0.0f), 0), finite_or(std::max(rgb.y, 0.0f), 0),
          finite_or(std::max(rgb.z, 0.0f), 0)};
}

// One material's statements, made what tinyobjloader reads right: it gets one material at a time, because it
// remembers a Kd beyond the material that has it.
class MaterialText {
 public:
  explicit MaterialText(std::string name) : name_(std::move(name)) {}

  void add(std::string_view keyword, std::string_view rest, const std::string& place, ObjWarnings& warnings) {
    std::vector<std::string_view> words = words_of(rest);
    if (is_colour(keyword)) return add_colour(keyword, words, place, warnings);
    if (keyword == "d" && !words.empty() && words[0] == "-halo") words.erase(words.begin());
    if (keyword == "d" || keyword == "Tr") {
      if (words.empty() || !looks_like_number(words[0])) return;
      (keyword == "d" ? dissolve_ : transparency_) = std::string(words[0]);
      opacity_place_ = place;
      return;
    }
    if (const MaterialMap* const kind = find_map(lower_case(keyword)))
      return add_map(*kind, rest, place, warnings);
    if (keyword == "Pr" || keyword == "Pm") {
      if (words.empty() || !is_number(words[0])) return;
      const float number = std::strtof(std::string(words[0]).c_str(), nullptr);
      (keyword == "Pr" ? maps_.roughness : maps_.metallic) = std::clamp(number, 0.0f, 1.0f);
      return;
    }
    text_ += keyword;
    append(words);
  }

  Material finish(ObjWarnings& warnings) {
    check_opacity(warnings);
    if (dissolve_ || transparency_) {
      text_.append(dissolve_ ? "d" : "Tr");
      append({dissolve_ ? *dissolve_ : *transparency_});
    }
    std::istringstream file("newmtl m\n" + text_);
    std::vector<tinyobj::material_t> read;
    std::map<std::string, int> ignored_map;
    tinyobj::LoadMtl(&ignored_map, &read, &file, nullptr, nullptr);
    return to_material(read.back());
  }

 private:
  void add_colour(std::string_view keyword, std::vector<std::string_view> words, const std::string& place,
                  ObjWarnings& warnings) {
    const bool is_xyz = !words.empty() && words[0] == "xyz";
    if (is_xyz) words.erase(words.begin());
    if (words.empty()) return;
    // Where only r is given, g and b equal it.
    if (words.size() == 1) words.resize(3, words[0]);
    words.resize(std::min(words.size(), std::size_t{3}));
    if (words.size() < 3 || !std::all_of(words.begin(), words.end(), is_number)) {
      if (keyword == "Kd" || keyword == "Ke") {
        warnings.add(ObjWarning::COLOUR_NOT_READ, place,
                     std::string(keyword) + " of material '" + printable(std::string_view(name_)) +
                         "' is not given in one or three numbers and not read");
      }
      return;
    }
    text_ += keyword;
    append(words);
    is_xyz_[keyword] = is_xyz;
    if (keyword == "Kd") has_diffuse_ = true;
    if (keyword == "Tf") has_filter_ = true;
  }

  void add_map(const MaterialMap& kind, std::string_view rest, const std::string& place,
               ObjWarnings& warnings) {
    MtlMap read = parse_mtl_map(rest);
    if (read.has_unused) {
      warnings.add(ObjWarning::TEXTURE_OPTION, place,
                   std::string(kind.name) + " of material '" + printable(std::string_view(name_)) +
                       "' has -mm or -t, which are not used");
    }
    read.map.may_cut_out = kind.map == &Material::diffuse_map;
    if (read.map) maps_.*kind.map = std::move(read.map);
  }

  void append(const std::vector<std::string_view>& words) {
    for (const std::string_view word : words) text_.append(" ").append(shorten_exponent(word));
    text_ += '\n';
  }

  // d wins over Tr, which is not in the specification and stands for its opposite in some exporters.
  void check_opacity(ObjWarnings& warnings) const {
    if (!dissolve_ || !transparency_) return;
    const float opacity = std::strtof(dissolve_->c_str(), nullptr);
    const float transparency = std::strtof(transparency_->c_str(), nullptr);
    if (std::abs(opacity + transparency - 1) <= 1e-3f) return;
    warnings.add(ObjWarning::D_AND_TR, opacity_place_,
                 "d and Tr of material '" + printable(std::string_view(name_)) + "' do not agree, d is used");
  }

  glm::vec3 colour(std::string_view keyword, const tinyobj::real_t (&numbers)[3]) const {
    const auto found = is_xyz_.find(keyword);
    const glm::vec3 rgb = to_colour(numbers);
    return found != is_xyz_.end() && found->second ? xyz_to_rgb(rgb) : rgb;
  }

  Material to_material(const tinyobj::material_t& mtl) const {
    Material material = maps_;
    material.name = name_;
    if (has_diffuse_) material.diffuse = colour("Kd", mtl.diffuse);
    if (has_filter_) material.filter = colour("Tf", mtl.transmittance);
    material.specular = colour("Ks", mtl.specular);
    material.emission = colour("Ke", mtl.emission);
    material.shininess = finite_or(mtl.shininess, 1);
    material.opacity = std::clamp(finite_or(mtl.dissolve, 1), 0.0f, 1.0f);
    material.index_of_refraction = finite_or(mtl.ior, 1);
    material.illum = mtl.illum;
    return material;
  }

  std::string name_, text_;
  std::map<std::string_view, bool> is_xyz_;  // by keyword, those of KEYWORDS
  bool has_diffuse_ = false, has_filter_ = false;
  Material maps_;                                       // and the numbers that tinyobjloader does not read
  std::optional<std::string> dissolve_, transparency_;  // the numbers
  std::string opacity_place_;
};

}  // namespace

std::vector<Material> parse_mtl(std::string_view file, const std::string& name, ObjWarnings& warnings) {
  std::string text(without_padding(file));
  std::vector<Material> materials;
  std::optional<MaterialText> current;
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size();) {
    const StatementPlace statement = join_statement(text, begin);
    Words words(std::string_view(text).substr(begin, statement.end - begin));
    const std::string_view keyword = usual_spelling(words.next());
    if (keyword == "newmtl") {
      if (current) materials.push_back(current->finish(warnings));
      const std::string_view material = trim(words.rest());
      current.reset();  // what follows a newmtl without a name is no material
      if (!material.empty()) current.emplace(std::string(material));
    } else if (current && (find_map(lower_case(keyword)) ||
                           std::find(KEYWORDS.begin(), KEYWORDS.end(), keyword) != KEYWORDS.end())) {
      current->add(keyword, trim(words.rest()), name + ":" + std::to_string(line), warnings);
    }
    line += statement.lines;
    begin = statement.next;
  }
  if (current) materials.push_back(current->finish(warnings));
  return materials;
}

}  // namespace coppice
