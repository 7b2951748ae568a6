#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/scene.h"

namespace coppice {

// The keys "light" and "lights" of a scene file, which fits the schema, into a scene that has not been stood
// up. Throws InputError with file and JSON pointer.
void read_scene_lights(const nlohmann::json& file, const std::string& name, Scene& scene);

}  // namespace coppice
