#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/scene.h"

namespace coppice {

// Of the key "fog" of a scene that stands as it will be seen. Throws InputError for a box without room.
Fog read_scene_fog(const nlohmann::json& from, const std::string& name, const Scene& scene);

}  // namespace coppice
