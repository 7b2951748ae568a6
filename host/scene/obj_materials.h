#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/obj_mtl_files.h"
#include "scene/obj_warnings.h"
#include "scene/scene.h"

namespace coppice {

// The materials of the MTL files that an OBJ names. None of them can fail the load: what is missing or broken
// becomes a warning.
class ObjMaterials {
 public:
  ObjMaterials(FindMtl find, ObjWarnings& warnings) : find_(std::move(find)), warnings_(warnings) {}

  // Reads the files of an mtllib statement: `names` is all that follows the word, at `place` (file:line). The
  // whole is tried as one name first, then the names that end in .mtl, then each word. Where one is missing,
  // `stem`.mtl beside the OBJ takes its place.
  void read_library(std::string_view names, const std::string& stem, const std::string& place);

  // Reads `stem`.mtl for an OBJ that uses materials and names no file.
  void read_unnamed_library(const std::string& stem, const std::string& place);

  // Index of the material of that name, 0 (the default material) with a warning where there is none. Letter
  // case, blanks, quotes and a comment may differ where no name is the same.
  std::uint32_t find(const std::string& name, const std::string& place);

  // The default material, then those of the files in order.
  std::vector<Material> take() { return std::move(materials_); }

 private:
  // The name of the file that was found, or read before.
  std::optional<std::string> take_file(const std::string& name, MtlMatch match, const std::string& place);
  void take_near(const std::string& name, const std::string& stem, const std::string& place);
  void add_materials(const FoundMtl& file, const std::string& place);

  FindMtl find_;
  ObjWarnings& warnings_;
  std::vector<Material> materials_ = {Material{}};
  std::map<std::string, std::uint32_t, std::less<>> index_of_, index_of_folded_;
  std::set<std::string, std::less<>> statements_, files_;  // read
};

}  // namespace coppice
