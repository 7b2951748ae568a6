#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace coppice {

// Reads a PLY file, ASCII or binary of either byte order: x, y and z of the element "vertex", of any type of
// number, and the list "vertex_indices" or "vertex_index" of the element "face", or triangle strips. Polygons
// are triangulated. Other elements and properties are read over; colours are said. From the coordinates of a
// scene far from the origin an offset is subtracted (find_offset). Throws InputError "FILE:LINE: ..." for the
// header and ASCII, "FILE: ELEMENT INDEX: ..." for binary data. Nothing is reserved that the file only claims
// to hold.
Scene load_ply(const std::filesystem::path& path);

// The same of a file in memory. The scene has no name.
Scene parse_ply(std::string_view text, const std::string& name);

}  // namespace coppice
