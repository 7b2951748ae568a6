#pragma once

#include <string>
#include <string_view>

namespace coppice {

// What a reader must not do with an input, empty where there is nothing to complain of: see
// scene_complaint.h, and any exception but an InputError of one printable line that begins with the file's
// name.

// A .gltf or .glb; the external buffer "b.bin" holds 256 bytes, others are missing.
std::string complaint_about_gltf(std::string_view input);

// A scene file; mesh files whose names begin with "missing" are, others are small, some with a motion. After
// a line
// `===` come the bytes of every .anim file.
std::string complaint_about_scene_file(std::string_view input);

std::string complaint_about_ply(std::string_view input);

}  // namespace coppice
