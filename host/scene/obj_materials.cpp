#include "scene/obj_materials.h"

#include "scene/material_maps.h"
#include "scene/obj_lines.h"
#include "scene/obj_mtl.h"
#include "scene/printable.h"

namespace coppice {
namespace {

std::string in_quotes(std::string_view name) { return "'" + printable(name) + "'"; }

std::string_view without_quotes(std::string_view name) {
  const bool has_quotes = name.size() > 2 && name.front() == '"' && name.back() == '"';
  return has_quotes ? name.substr(1, name.size() - 2) : name;
}

// Blanks that are escaped, as some exporters do.
std::string without_escapes(std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == '\\' && i + 1 < name.size() && is_blank(name[i + 1])) continue;
    result += name[i];
  }
  return result;
}

// What stands before a word that begins with #.
std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#' && (i == 0 || is_blank(line[i - 1]))) return trim(line.substr(0, i));
  }
  return line;
}

// Cuts after every word that ends in .mtl.
std::vector<std::string> cut_at_extension(std::string_view names) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  Words words(names);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const auto end = static_cast<std::size_t>(word.data() + word.size() - names.data());
    const bool is_last = trim(words.rest()).empty();
    const std::string lower = lower_case(word);
    if (!is_last && !lower.ends_with(".mtl") && !lower.ends_with(".mtl\"")) continue;
    parts.emplace_back(trim(names.substr(begin, end - begin)));
    begin = end;
  }
  return parts;
}

// Words whose blanks may be escaped.
std::vector<std::string> cut_at_blanks(std::string_view names) {
  std::vector<std::string> parts;
  bool is_joined = false;
  Words words(names);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (is_joined)
      parts.back().append(" ").append(word);
    else
      parts.emplace_back(word);
    is_joined = word.ends_with('\\');
  }
  return parts;
}

// What two spellings of one name have in common. A # alone begins a comment; #25 is the end of a name.
std::string fold(std::string_view name) {
  std::string result;
  Words words(without_quotes(name));
  for (std::string_view word = words.next(); !word.empty() && word != "#"; word = words.next()) {
    result.append(result.empty() ? "" : " ").append(lower_case(word));
  }
  return result;
}

}  // namespace

void ObjMaterials::read_library(std::string_view names, const std::string& stem, const std::string& place) {
  if (!statements_.emplace(names).second) return;
  if (take_file(std::string(names), MtlMatch::AS_WRITTEN, place)) return;
  for (const std::string& name : cut_at_extension(without_comment(names))) {
    if (take_file(name, MtlMatch::AS_WRITTEN, place)) continue;
    std::vector<std::string> missing;
    const std::vector<std::string> words = cut_at_blanks(name);
    for (const std::string& word : words) {
      if (!take_file(word, MtlMatch::AS_WRITTEN, place)) missing.push_back(word);
    }
    if (missing.size() == words.size()) missing = {name};
    for (const std::string& part : missing) take_near(part, stem, place);
  }
}

void ObjMaterials::read_unnamed_library(const std::string& stem, const std::string& place) {
  const std::string name = stem + ".mtl";
  std::optional<std::string> found = take_file(name, MtlMatch::AS_WRITTEN, place);
  if (!found) found = take_file(name, MtlMatch::NEAR, place);
  if (!found) return;
  warnings_.add(ObjWarning::MTL_ELSEWHERE, place, "no mtllib in the file, " + in_quotes(*found) + " is used");
}

// Each way to understand a name that may be meant.
std::optional<std::string> ObjMaterials::take_file(const std::string& name, MtlMatch match,
                                                   const std::string& place) {
  std::vector<std::string> spellings = {name};
  for (const std::string& other : {std::string(without_quotes(name)), without_escapes(name)}) {
    if (other != name) spellings.push_back(other);
  }
  for (const std::string& tried : spellings) {
    if (files_.contains(tried)) return tried;
    if (const std::optional<FoundMtl> found = find_(tried, match)) {
      add_materials(*found, place);
      return found->name;
    }
  }
  return std::nullopt;
}

void ObjMaterials::take_near(const std::string& name, const std::string& stem, const std::string& place) {
  std::optional<std::string> found = take_file(name, MtlMatch::NEAR, place);
  const std::string beside = stem + ".mtl";
  if (!found && !files_.contains(beside)) found = take_file(beside, MtlMatch::AS_WRITTEN, place);
  if (!found) {
    warnings_.add(ObjWarning::MTL_NOT_FOUND, place, "material file " + in_quotes(name) + " not found");
  } else if (*found != name) {
    warnings_.add(ObjWarning::MTL_ELSEWHERE, place,
                  "material file " + in_quotes(name) + " not found, " + in_quotes(*found) + " is used");
  }
}

void ObjMaterials::add_materials(const FoundMtl& file, const std::string& place) {
  if (!files_.insert(file.name).second) return;
  const std::string name = printable(std::string_view(file.name));
  std::vector<Material> read = parse_mtl(file.text, name, warnings_);
  for (Material& material : read) lead_maps_from(material, std::filesystem::path(file.name).parent_path());
  if (read.empty()) {
    warnings_.add(ObjWarning::MTL_WITHOUT_MATERIAL, place, "no material in " + in_quotes(file.name));
  }
  for (const Material& material : read) {
    const auto next = static_cast<std::uint32_t>(materials_.size());
    const auto [entry, is_new] = index_of_.try_emplace(material.name, next);
    if (is_new) {
      index_of_folded_.try_emplace(fold(material.name), next);
      materials_.push_back(material);
    } else if (materials_[entry->second] != material) {
      warnings_.add(
          ObjWarning::MATERIAL_TWICE, name,
          "material " + in_quotes(material.name) + " is defined again, the first definition is used");
    }
  }
}

std::uint32_t ObjMaterials::find(const std::string& name, const std::string& place) {
  const auto found = index_of_.find(name);
  if (found != index_of_.end()) return found->second;
  std::uint32_t index = 0;
  const auto folded = index_of_folded_.find(fold(name));
  if (folded != index_of_folded_.end()) {
    index = folded->second;
    warnings_.add(
        ObjWarning::MATERIAL_SPELT_OTHERWISE, place,
        "material " + in_quotes(name) + " not found, " + in_quotes(materials_[index].name) + " is used");
  } else {
    warnings_.add(ObjWarning::MATERIAL_NOT_FOUND, place,
                  "material " + in_quotes(name) + " not found, default used");
  }
  index_of_.emplace(name, index);
  return index;
}

}  // namespace coppice
