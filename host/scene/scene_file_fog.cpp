#include "scene/scene_file_fog.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/json_check.h"
#include "scene/scene_file_tracks.h"

namespace coppice {
namespace {

using nlohmann::json;

FogBox read_fog_box(const json& from, const std::string& name, const Scene& scene) {
  const glm::dvec3 least(vector_of(from["min"])), greatest(vector_of(from["max"]));
  for (int axis = 0; axis < 3; ++axis) {
    if (!(least[axis] < greatest[axis]))
      fail_at(name, "/fog/box/max/" + std::to_string(axis),
              shortened(from["max"][static_cast<std::size_t>(axis)]) +
                  ", expected a number above that of \"min\"");
  }
  return fog_box(glm::vec3(to_scene(scene, least)), glm::vec3(to_scene(scene, greatest)));
}

}  // namespace

Fog read_scene_fog(const json& from, const std::string& name, const Scene& scene) {
  Fog fog;
  fog.origin = "/fog";
  fog.density = static_cast<float>(std::ldexp(from["density"].get<double>(), -scene.scale_exponent));
  if (from.contains("albedo")) fog.albedo = vector_of(from["albedo"]);
  fog.anisotropy = from.value("anisotropy", fog.anisotropy);
  if (from.contains("box")) fog.box = read_fog_box(from["box"], name, scene);
  return fog;
}

}  // namespace coppice
