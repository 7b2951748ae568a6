#include "scene/scene_file_instances.h"

#include <nlohmann/json.hpp>

#include "scene/json_check.h"

namespace coppice {

void check_swarm(const nlohmann::json& file, const std::string& name) {
  if (!file["instances"].contains("swarm")) return;
  for (std::size_t i = 0; i < file["objects"].size(); ++i) {
    if (file["objects"][i].contains("keyframes"))
      fail_at(name, "/objects/" + std::to_string(i) + "/keyframes", "does not go with a \"swarm\"");
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
