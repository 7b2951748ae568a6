#include "scene/scene_file_instances.h"

#include <nlohmann/json.hpp>

#include "scene/json_check.h"

namespace coppice {

void check_stands_still(const nlohmann::json& file, const std::string& name) {
  const auto refuse = [&](const nlohmann::json& from, const std::string& pointer, const char* key) {
    if (from.contains(key)) fail_at(name, pointer + "/" + key, "does not go with \"instances\"");
  };
  refuse(file, "", "duration");
  if (file.contains("camera")) refuse(file["camera"], "/camera", "keyframes");
  for (std::size_t i = 0; i < file["objects"].size(); ++i) {
    for (const char* const key : {"keyframes", "deform"})
      refuse(file["objects"][i], "/objects/" + std::to_string(i), key);
  }
}

std::optional<Swarm> read_swarm(const nlohmann::json& instances, double frames_per_second) {
  if (!instances.contains("swarm")) return {};
  Swarm swarm;
  swarm.seed = instances["swarm"].value("seed", swarm.seed);
  swarm.seconds = instances["swarm"].value("seconds", swarm.seconds);
  swarm.frames_per_second = frames_per_second;
  return swarm;
}

}  // namespace coppice
