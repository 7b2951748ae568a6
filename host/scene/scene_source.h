#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace coppice {

// The largest N that a generated scene may be asked for.
inline constexpr std::uint32_t MAX_GENERATED_TRIANGLES = 1u << 26;

// A scene that open_scene knows by name.
struct SceneListing {
  std::string name;         // as open_scene takes it
  std::string description;  // one line
  std::uint32_t triangles;  // the number of triangles without ":N"
  bool takes_count;         // whether ":N" may follow the name, N from 1 to MAX_GENERATED_TRIANGLES
};

// All built-in scenes, the default one first.
std::vector<SceneListing> list_scenes();

// Opens what the user named: the path of an .obj file, "grove", "scatter[:N]", "terrain[:N]" or
// "hard:CASE[:N]". A built-in name wins over a file of the same name ("./grove" names the file). The scene is
// brought into range. Throws InputError where nothing answers to the name, N is out of range, or the file
// cannot be loaded.
Scene open_scene(const std::string& spec);

}  // namespace coppice
