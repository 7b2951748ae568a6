#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/scene_file.h"

namespace coppice {

// Opens what an entry of "meshes" in a scene file says, at `pointer` in the file `name`.
Scene open_scene_file_mesh(const nlohmann::json& mesh, const std::string& name, const std::string& pointer,
                           const SceneFileSources& sources);

// A scene that follows an .anim file: u32 magic 0x4d494e41, vertices, frames, triangles, then vertices * 3
// float32 of each frame, all little-endian; the faces and materials are those of `faces`. Throws InputError
// "NAME: ...".
Scene make_anim_scene(const std::string& bytes, const std::string& name, Scene faces);

}  // namespace coppice
