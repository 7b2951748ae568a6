#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/gltf_rig.h"
#include "scene/scene_compose.h"

namespace coppice {

// Parts of a scene file that fit its schema. Each throws InputError with `name` and a JSON pointer that
// begins with `pointer`.

glm::vec3 vector_of(const nlohmann::json& numbers);

// Unit length.
glm::dvec3 direction_of(const nlohmann::json& numbers, const std::string& name, const std::string& pointer);

// Of an object: "translation", "rotation" and "scale", or "matrix".
NodeTransform read_transform(const nlohmann::json& object, const std::string& name,
                             const std::string& pointer);

// Of an object's "keyframes", as tracks of that node.
void read_object_tracks(const nlohmann::json& object, const std::string& name, const std::string& pointer,
                        std::uint32_t node, std::vector<NodeTrack>& tracks);

CameraTracks read_scene_camera(const nlohmann::json& camera, const std::string& name,
                               const std::string& pointer);

// The aperture and the focus of the same.
Lens read_scene_lens(const nlohmann::json& camera);

}  // namespace coppice
