#include "scene/load_obj.h"

#include "scene/material_maps.h"
#include "scene/obj_file.h"
#include "scene/obj_materials.h"
#include "scene/obj_offset.h"
#include "scene/printable.h"

namespace coppice {
namespace {

// A usemtl may stand before the mtllib that has its material, so all files are read first.
void apply_materials(const ObjMesh& mesh, const std::string& name, const std::string& stem,
                     const FindMtl& find_mtl, ObjWarnings& warnings, Scene& scene) {
  const auto place = [&](std::size_t line) { return name + ":" + std::to_string(line); };
  ObjMaterials materials(find_mtl, warnings);
  for (const ObjPart::Library& library : mesh.libraries) {
    materials.read_library(library.names, stem, place(library.line));
  }
  if (mesh.libraries.empty() && !mesh.uses.empty()) {
    materials.read_unnamed_library(stem, place(mesh.uses[0].line));
  }
  scene.material_index.reserve(scene.indices.size());
  std::uint32_t current = 0;
  for (const ObjMesh::MaterialUse& use : mesh.uses) {
    scene.material_index.resize(use.triangle, current);
    current = materials.find(use.name, place(use.line));
  }
  scene.material_index.resize(scene.indices.size(), current);
  scene.materials = materials.take();
}

}  // namespace

// Coordinates are read again where the first reading finds that the scene is far from the origin, so that
// they are rounded once, as they are read. A third time where not even its place was seen the first time, for
// float rounded all to one point.
Scene parse_obj(std::string_view text, const std::string& name, const FindMtl& find_mtl,
                const ObjReading& reading) {
  Scene scene;
  ObjWarnings warnings;
  ObjMesh mesh;
  for (int reread = 0; reread < 3; ++reread) {
    warnings = {};
    mesh = read_obj_mesh(text, name, scene.offset, reading, warnings);
    scene.positions = std::move(mesh.positions);
    scene.indices = std::move(mesh.triangles);
    scene.texcoords = std::move(mesh.texcoords);
    scene.texcoord_index = std::move(mesh.texcoord_index);
    scene.normals = std::move(mesh.normals);
    scene.normal_index = std::move(mesh.normal_index);
    scene.face_digest = mesh.faces.value();
    const glm::dvec3 offset = reread < 2 ? find_offset(scene) : glm::dvec3{0};
    if (offset == glm::dvec3{0}) break;
    scene.offset += offset;
  }
  apply_materials(mesh, name, std::filesystem::path(name).stem().string(), find_mtl, warnings, scene);
  scene.warnings = warnings.lines();
  if (scene.offset != glm::dvec3{0}) scene.warnings.push_back(name + ": " + describe_offset(scene.offset));
  return scene;
}

Scene load_obj(const std::filesystem::path& path) {
  const std::string name = printable(path);
  const ObjFile file = read_obj_file(path);
  MtlFolder folder(path.parent_path());
  ObjReading reading;
  if (show_load_progress && file.text().size() >= LONG_OBJ_BYTES) {
    reading.progress = [&](double done) { show_load_progress(name, done); };
  }
  const auto find_mtl = [&](const std::string& mtl, MtlMatch match) { return folder.find(mtl, match); };
  Scene scene = parse_obj(file.text(), name, find_mtl, reading);
  for (Material& material : scene.materials) lead_maps_from(material, path.parent_path());
  scene.name = printable(path.stem());
  return scene;
}

}  // namespace coppice
