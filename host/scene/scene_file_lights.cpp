#include "scene/scene_file_lights.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/json_check.h"
#include "scene/scene_file_tracks.h"

namespace coppice {
namespace {

using nlohmann::json;

// The one of the key "light".
void read_single(const json& light, const std::string& name, Scene& scene) {
  scene.light_origin = "/light";
  if (light.contains("direction"))
    scene.light.direction = glm::vec3(direction_of(light["direction"], name, "/light/direction"));
  if (light.contains("radiance")) scene.light.radiance = vector_of(light["radiance"]);
  if (light.contains("ambient")) scene.ambient_light = vector_of(light["ambient"]);
  scene.light.shadows = light.value("shadows", false);
}

Light read_one_of(const json& from, const std::string& name, const std::string& pointer, const Scene& scene) {
  if (from.contains("direction") == from.contains("position"))
    fail_at(name, pointer, "expected a \"direction\" or a \"position\", one of both");
  Light light;
  light.origin = pointer;
  light.is_point = from.contains("position");
  if (light.is_point) {
    light.place = glm::vec3(to_scene(scene, glm::dvec3(vector_of(from["position"]))));
  } else {
    light.place = glm::vec3(direction_of(from["direction"], name, pointer + "/direction"));
  }
  if (from.contains("radiance")) light.radiance = vector_of(from["radiance"]);
  light.shadows = from.value("shadows", false);
  return light;
}

// The environment is yet to come.
bool is_dark(const Scene& scene, const json& file) {
  if (file.contains("environment") && file["environment"].value("intensity", 1.0) > 0) return false;
  const auto black = [](const glm::vec3& colour) { return colour == glm::vec3(0); };
  return black(scene.ambient_light) && black(scene.light.radiance) &&
         std::ranges::all_of(scene.more_lights, [&](const Light& l) { return black(l.radiance); }) &&
         std::ranges::all_of(scene.materials, [&](const Material& m) { return black(m.emission); });
}

}  // namespace

void read_scene_lights(const json& file, const std::string& name, Scene& scene) {
  if (file.contains("light")) read_single(file["light"], name, scene);
  if (file.contains("lights")) {
    std::vector<Light> lights;
    const json& listed = file["lights"];
    for (std::size_t i = 0; i < listed.size(); ++i)
      lights.push_back(read_one_of(listed[i], name, "/lights/" + std::to_string(i), scene));
    // A "light" that has more than the ambient colour is one more, before the others.
    const bool has_light = file.contains("light") && file["light"].size() > file["light"].count("ambient");
    if (has_light) {
      scene.more_lights = std::move(lights);
    } else {
      set_lights(scene, std::move(lights));
    }
  }
  if (file.contains("global_illumination")) {
    scene.global_illumination = true;
    scene.bounces = file["global_illumination"].value("bounces", scene.bounces);
  }
  if (!is_dark(scene, file)) return;
  scene.warnings.push_back(name + ": no light at all, the default light is taken");
  const Scene with_default;
  scene.light = with_default.light;
  scene.light_origin.clear();
  scene.ambient_light = with_default.ambient_light;
}

}  // namespace coppice
