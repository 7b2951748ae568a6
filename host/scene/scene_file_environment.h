#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/scene.h"

namespace coppice {

// Of the key "environment" of a scene file that fits its schema. The scene has been turned as its file says.
// Throws InputError with `name` and a JSON pointer.
Environment read_scene_environment(const nlohmann::json& environment, const std::string& name,
                                   const Scene& scene);

}  // namespace coppice
