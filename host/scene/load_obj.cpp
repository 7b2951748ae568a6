#include "scene/load_obj.h"

#include <fstream>
#include <iterator>
#include <sstream>

#include "scene/obj_materials.h"
#include "scene/obj_offset.h"
#include "scene/obj_text.h"
#include "scene/printable.h"
#include "scene/triangulate.h"

namespace coppice {
namespace {

// What tinyobjloader's callbacks add to. They come in file order, over text that has been checked.
struct Reading {
  Scene& scene;
  ObjMaterials& materials;
  std::int64_t vertices_so_far = 0;
  std::uint32_t material = 0;
  std::size_t crossing_count = 0;      // polygons that are no area
  std::vector<std::uint32_t> polygon;  // reused

  void add_face(std::span<const tinyobj::index_t> corners) {
    polygon.clear();
    for (const tinyobj::index_t& corner : corners) {
      const std::int64_t i = corner.vertex_index;  // from 1, or from -1 backwards
      polygon.push_back(static_cast<std::uint32_t>(i > 0 ? i - 1 : vertices_so_far + i));
    }
    crossing_count += !triangulate(scene.positions, polygon, scene.indices);
    scene.material_index.resize(scene.indices.size(), material);
  }
};

tinyobj::callback_t callbacks() {
  tinyobj::callback_t result;
  result.vertex_cb = [](void* user, auto...) { ++static_cast<Reading*>(user)->vertices_so_far; };
  result.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
    static_cast<Reading*>(user)->add_face({corners, static_cast<std::size_t>(count)});
  };
  result.usemtl_cb = [](void* user, const char* name, int) {
    auto& reading = *static_cast<Reading*>(user);
    reading.material = reading.materials.find(name);
  };
  return result;
}

// `offset` is subtracted from all coordinates.
Scene parse_once(std::string text, const std::string& name, const ObjMaterials::ReadMtl& read_mtl,
                 glm::dvec3 offset) {
  ObjText obj = check_obj_text(std::move(text), name, offset);
  Scene scene;
  scene.offset = offset;
  // Ours, not tinyobjloader's: it reads what is no number as 0, and rounds decimals less well.
  scene.positions = std::move(obj.positions);
  scene.warnings = std::move(obj.warnings);

  // By callbacks, not LoadObj: that one drops triangles of polygons that it cannot cut, takes quadratic time
  // over large ones, and fails on lines and points with odd indices, which we have no use for.
  ObjMaterials materials(read_mtl, scene.warnings);
  Reading reading{.scene = scene, .materials = materials, .polygon = {}};
  std::istringstream stream(std::move(obj.text));
  tinyobj::LoadObjWithCallback(stream, callbacks(), &reading, &materials);
  scene.materials = materials.take();
  if (reading.crossing_count > 0) {
    scene.warnings.push_back(name + ": " + std::to_string(reading.crossing_count) +
                             (reading.crossing_count == 1 ? " polygon" : " polygons") +
                             " with edges that cross or go round twice, cut into triangles that may overlap");
  }
  return scene;
}

// Reads again where the first reading finds that the scene is far from the origin, so that the coordinates of
// all others are rounded once, as they are read. A third time where not even its place was seen the
// first time, for float rounded all to one point.
Scene parse(const std::function<std::string()>& text, const std::string& name,
            const ObjMaterials::ReadMtl& read_mtl) {
  Scene scene = parse_once(text(), name, read_mtl, glm::dvec3{0});
  for (int again = 0; again < 2; ++again) {
    const glm::dvec3 offset = find_offset(scene);
    if (offset == glm::dvec3{0}) break;
    scene = parse_once(text(), name, read_mtl, scene.offset + offset);
  }
  if (scene.offset != glm::dvec3{0}) scene.warnings.push_back(name + ": " + describe_offset(scene.offset));
  return scene;
}

}  // namespace

Scene parse_obj(std::string text, const std::string& name,
                const std::function<std::optional<std::string>(const std::string& name)>& read_mtl) {
  return parse([&] { return text; }, name, read_mtl);
}

Scene load_obj(const std::filesystem::path& path) {
  const auto read_mtl = [folder = path.parent_path()](const std::string& name) -> std::optional<std::string> {
    std::error_code error;
    std::ifstream file;
    if (std::filesystem::is_regular_file(folder / name, error)) file.open(folder / name, std::ios::binary);
    if (!file.is_open()) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  Scene scene = parse([&] { return read_obj_file(path); }, printable(path), read_mtl);
  scene.name = printable(path.stem());
  return scene;
}

}  // namespace coppice
