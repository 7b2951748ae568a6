#include "scene/scene_file_environment.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/json_check.h"
#include "scene/scene_file_tracks.h"

namespace coppice {
namespace {

using nlohmann::json;

constexpr double least_height = -1e-6;  // of a sun at the horizon, as rounded

Sky read_sky(const json& from, const std::string& name, const Scene& scene) {
  Sky sky;
  sky.turbidity = from.value("turbidity", sky.turbidity);
  sky.ground = from.value("ground", sky.ground);
  if (!from.contains("sun_direction")) return sky;
  const std::string pointer = "/environment/sky/sun_direction";
  const glm::dvec3 sun = direction_to_scene(scene, direction_of(from["sun_direction"], name, pointer));
  if (sun.y < least_height)
    fail_at(name, pointer,
            shortened(from["sun_direction"]) + ", expected a direction that is not below the horizon");
  sky.sun = glm::vec3(glm::dvec3(sun.x, std::max(sun.y, 0.0), sun.z));
  return sky;
}

}  // namespace

Environment read_scene_environment(const json& from, const std::string& name, const Scene& scene) {
  if (from.contains("image") == from.contains("sky"))
    fail_at(name, "/environment", "expected an \"image\" or a \"sky\", one of both");
  if (from.contains("rotation") && !from.contains("image"))
    fail_at(name, "/environment/rotation", "goes with an \"image\", expected a \"sun_direction\" of the sky");
  Environment environment;
  environment.origin = "/environment";
  environment.intensity = from.value("intensity", environment.intensity);
  environment.rotation_degrees = from.value("rotation", environment.rotation_degrees);
  if (from.contains("image")) environment.image = from["image"].get<std::string>();
  if (from.contains("sky")) environment.sky = read_sky(from["sky"], name, scene);
  return environment;
}

}  // namespace coppice
