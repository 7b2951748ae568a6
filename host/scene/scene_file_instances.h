#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace coppice {

// Of a scene file with "instances": throws InputError where a swarm, which moves all objects together, meets
// an object that has keyframes of its own.
void check_swarm(const nlohmann::json& file, const std::string& name);

// Of "instances"; none without a "swarm".
std::optional<Swarm> read_swarm(const nlohmann::json& instances, double frames_per_second);

}  // namespace coppice
