#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "scene/load_gltf.h"
#include "scene/scene.h"

namespace coppice {

// How a scene file comes to what it names. Each throws InputError.
struct SceneFileSources {
  std::function<Scene(const std::string& path, const GltfReading&)> mesh;  // of an OBJ, glTF or PLY file
  std::function<Scene(const std::string& name)> built_in;
  std::function<std::string(const std::string& path)> bytes;
  bool keeps_instances = true;  // else a file that has them is read as one without "instances"
};

// Reads a scene file; docs/scenes.md says what is in it, scenes/scene.schema.json checks it first. All
// objects become one mesh, or instances where the file says so. `keep_instances`: those that move by
// keyframes or deform come as one mesh that moves unless they are to be kept; those that do not come as
// instances in any case. Throws InputError "FILE: POINTER: ..." with a JSON pointer to what is wrong.
Scene load_scene_file(const std::filesystem::path& path, bool keep_instances = true);

// The same of a text in memory. The scene has no name.
Scene parse_scene_file(std::string_view text, const std::string& name, const SceneFileSources& sources);

}  // namespace coppice
