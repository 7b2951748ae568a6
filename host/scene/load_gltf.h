#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace coppice {

// Gives the bytes of an external buffer by its URI, percent signs decoded. Throws InputError.
using FindBytes = std::function<std::string(const std::string& uri)>;

struct GltfReading {
  std::optional<std::string> animation;  // only the one of this name or index; else those that go together
};

// Reads a glTF 2.0 file, .gltf or .glb; docs/gltf.md says what of it. All triangles of the default scene
// become one mesh; what an animation moves has joints, and Scene::motion holds how. Without an animation
// there is no motion: skins and morph targets are then applied once. From the coordinates of a scene that
// stands still far from the origin an offset is subtracted (find_offset). What is odd but usable is told in
// Scene::warnings. Throws InputError "FILE: POINTER: ..." with a JSON pointer to what is wrong: every index,
// offset, count and type is checked, and nothing is reserved that the file only claims to hold.
Scene load_gltf(const std::filesystem::path& path, const GltfReading& reading = {});

// The same of a file in memory. The scene has no name.
Scene parse_gltf(std::string_view text, const std::string& name, const FindBytes& find,
                 const GltfReading& reading = {});

}  // namespace coppice
