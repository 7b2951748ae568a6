#include <algorithm>

#include "scene/bounds.h"
#include "scene/input_error.h"
#include "scene/instances.h"
#include "scene/obj_offset.h"
#include "scene/scene_compose.h"
#include "scene/scene_source.h"

namespace coppice {
namespace {

void append_instanced_mesh(Scene& scene, const Scene& mesh) {
  if (scene.indices.size() + mesh.indices.size() > MAX_GENERATED_TRIANGLES)
    throw InputError("meshes come to more than " + std::to_string(MAX_GENERATED_TRIANGLES) + " triangles");
  const auto vertex = static_cast<std::uint32_t>(scene.positions.size());
  const auto material = static_cast<std::uint32_t>(scene.materials.size());
  scene.meshes.push_back(
      {static_cast<std::uint32_t>(scene.indices.size()), static_cast<std::uint32_t>(mesh.indices.size())});
  scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const glm::uvec3& corners : mesh.indices) scene.indices.push_back(corners + vertex);
  for (const std::uint32_t index : mesh.material_index) scene.material_index.push_back(material + index);
  scene.materials.insert(scene.materials.end(), mesh.materials.begin(), mesh.materials.end());
}

glm::mat4x3 rounded(glm::dmat4 place, glm::dvec3 offset) {
  place[3] -= glm::dvec4(offset, 0);
  return glm::mat4x3(glm::dmat4x3(place));
}

void move_camera(Scene& scene, glm::dvec3 offset) {
  if (!scene.camera) return;
  for (glm::vec3* const point : {&scene.camera->position, &scene.camera->target})
    *point = glm::vec3(glm::dvec3(*point) - offset);
  if (!is_finite(scene.camera->position) || !is_finite(scene.camera->target)) scene.camera.reset();
}

}  // namespace

Scene compose_instances(const InstanceComposition& composition) {
  Scene scene;
  scene.materials.clear();
  for (const Scene& mesh : composition.meshes) append_instanced_mesh(scene, mesh);
  if (scene.materials.empty()) scene.materials = {Material{}};
  scene.camera = composition.camera;
  std::vector<glm::dmat4> places;
  for (const auto& [mesh, place] : composition.placed) {
    const Scene& of = composition.meshes[mesh];
    places.push_back(place * from_offset(of));
    scene.instances.push_back({mesh, rounded(places.back(), glm::dvec3{0})});
    if (of.camera && !scene.camera) scene.camera = moved_camera(*of.camera, places.back());
  }
  scene.offset = find_offset(boxes_of_instances(scene));
  move_camera(scene, scene.offset);
  if (scene.offset == glm::dvec3{0}) return scene;
  for (std::size_t i = 0; i < places.size(); ++i)
    scene.instances[i].transform = rounded(places[i], scene.offset);
  scene.warnings.push_back(describe_offset(scene.offset));
  return scene;
}

}  // namespace coppice
