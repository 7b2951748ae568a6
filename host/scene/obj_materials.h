#pragma once

#include <tiny_obj_loader.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace coppice {

// Reads the MTL files that an OBJ names. None of them can fail the load: what is missing or broken becomes a
// warning.
class ObjMaterials : public tinyobj::MaterialReader {
 public:
  // The text of the file of that name, nothing where there is none.
  using ReadMtl = std::function<std::optional<std::string>(const std::string& name)>;

  // Warnings are appended to `warnings`.
  ObjMaterials(ReadMtl read, std::vector<std::string>& warnings);

  // tinyobjloader's hook, called for each file that `mtllib` names.
  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* material_map, std::string* warning,
                  std::string* error) override;

  // Index of the material of that name, 0 (the default material) with a warning where there is none.
  std::uint32_t find(std::string name);

  // The default material, then those of the files in order.
  std::vector<Material> take() { return std::move(materials_); }

 private:
  void warn(std::string line);

  ReadMtl read_;
  std::vector<std::string>& warnings_;
  std::vector<Material> materials_ = {Material{}};
  std::map<std::string, std::uint32_t, std::less<>> index_of_;
};

}  // namespace coppice
