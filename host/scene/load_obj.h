#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "scene/obj_mtl_files.h"
#include "scene/obj_reader.h"
#include "scene/scene.h"

namespace coppice {

// Reads a Wavefront OBJ file and the MTL files it names; docs/obj.md says what of them. Polygons are
// triangulated; all shapes become one mesh, in file order; normals, texture coordinates, lines and points are
// read over. Degenerate triangles are kept. A coordinate that is no number, or none that float can hold,
// arrives as non-finite, so that its triangles are inactive and not wrong. The default material is
// materials[0], those of the MTL files follow. From the coordinates of a scene that is far from the origin
// for its size an offset is subtracted, in double (Scene::offset, find_offset). What is odd but usable (no
// faces, a face with fewer than three corners, a missing or broken MTL, an unknown material, polygons that
// cross themselves, an offset) is told in Scene::warnings, one line a kind. Throws InputError, with the line
// number where there is one, if the file is missing, no regular file, empty or no OBJ at all, has a vertex
// with fewer than three coordinates or a face with an index that is zero, out of range or no number.
Scene load_obj(const std::filesystem::path& path);

// The same of a text in memory. `name` begins the messages, and its stem is the OBJ's; `find_mtl` gives the
// MTL files, nothing where there is none. The scene has no name.
Scene parse_obj(std::string_view text, const std::string& name, const FindMtl& find_mtl,
                const ObjReading& reading = {});

// Set by a program that shows how far the loading of a long file is: called from any thread with the share
// that is done, and with 1 at the end.
inline std::function<void(const std::string& name, double done)> show_load_progress;

}  // namespace coppice
