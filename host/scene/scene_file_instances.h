#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace coppice {

// Of a scene file with "instances", which move all together or not at all: throws InputError where anything
// else says that it moves.
void check_stands_still(const nlohmann::json& file, const std::string& name);

// Of "instances"; none without a "swarm".
std::optional<Swarm> read_swarm(const nlohmann::json& instances, double frames_per_second);

}  // namespace coppice
