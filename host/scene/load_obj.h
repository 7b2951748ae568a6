#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace coppice {

// Reads a Wavefront OBJ file and the MTL files it names. Polygons are triangulated; all shapes become one
// mesh, in file order; normals, texture coordinates, lines and points are read over. Degenerate triangles are
// kept. A coordinate that is no number, or none that float can hold, arrives as non-finite, so that its
// triangles are inactive and not wrong. The default material is materials[0], those of the MTL files follow;
// a Ka that is absent or black is taken from Kd. From the coordinates of a scene that is far from the origin
// for its size an offset is subtracted, in double (Scene::offset, find_offset). What is odd but usable (no
// faces, a missing or broken MTL, an unknown material, polygons that cross themselves, an offset) is told in
// Scene::warnings. Throws InputError, with the line number where there is one, if the file is missing, a
// directory, empty or no OBJ at all, or has a face with fewer than three vertices or with an index that is
// zero, out of range or no number.
Scene load_obj(const std::filesystem::path& path);

// The same of a text in memory. `name` begins the messages; `read_mtl` gives the text of an MTL file by the
// name in the OBJ, nothing where there is none. The scene has no name.
Scene parse_obj(std::string text, const std::string& name,
                const std::function<std::optional<std::string>(const std::string& name)>& read_mtl);

}  // namespace coppice
