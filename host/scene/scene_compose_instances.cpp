#include <algorithm>

#include "scene/bounds.h"
#include "scene/corner_attributes.h"
#include "scene/input_error.h"
#include "scene/instance_rig.h"
#include "scene/instances.h"
#include "scene/obj_offset.h"
#include "scene/scene_compose.h"
#include "scene/scene_source.h"

namespace coppice {
namespace {

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

class InstanceComposer {
 public:
  explicit InstanceComposer(const InstanceComposition& composition)
      : from_(composition), moving_(moving_nodes(composition.nodes)) {
    for (const NodeTrack& track : from_.nodes.tracks)
      duration_ = std::max(duration_, track.keyframes.times.back());
    if (from_.camera) duration_ = std::max(duration_, from_.camera->end());
  }

  Scene compose() {
    scene_.materials.clear();
    for (const Scene& mesh : from_.meshes) add_mesh(mesh);
    if (scene_.materials.empty()) scene_.materials = {Material{}};
    if (from_.camera) scene_.camera = from_.camera->at(0);
    add_instances();
    add_motion();
    return std::move(scene_);
  }

 private:
  void add_mesh(const Scene& mesh);
  void add_instances();
  void add_motion();
  InstanceRig::Placed placed_at(const InstanceComposition::Placed& placed);

  const InstanceComposition& from_;
  MovingNodes moving_;
  Scene scene_;
  std::optional<InstanceRig::Eye> eye_;
  double duration_ = 0;
};

void InstanceComposer::add_mesh(const Scene& mesh) {
  if (scene_.indices.size() + mesh.indices.size() > MAX_GENERATED_TRIANGLES)
    throw InputError("meshes come to more than " + std::to_string(MAX_GENERATED_TRIANGLES) + " triangles");
  const auto vertex = static_cast<std::uint32_t>(scene_.positions.size());
  const auto material = static_cast<std::uint32_t>(scene_.materials.size());
  scene_.meshes.push_back({static_cast<std::uint32_t>(scene_.indices.size()),
                           static_cast<std::uint32_t>(mesh.indices.size()), vertex, mesh.motion});
  if (mesh.motion) duration_ = std::max(duration_, mesh.motion->duration_seconds);
  scene_.positions.insert(scene_.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const glm::uvec3& corners : mesh.indices) scene_.indices.push_back(corners + vertex);
  append_corner_attributes(mesh, 0, mesh.indices.size(), {}, scene_);
  for (const std::uint32_t index : mesh.material_index) scene_.material_index.push_back(material + index);
  scene_.materials.insert(scene_.materials.end(), mesh.materials.begin(), mesh.materials.end());
}

InstanceRig::Placed InstanceComposer::placed_at(const InstanceComposition::Placed& placed) {
  const int node = moving_.index[placed.node];
  return {node >= 0 ? static_cast<std::uint32_t>(node)
                    : add_still_node(moving_.nodes, from_.nodes.transforms(0)[placed.node]),
          from_offset(from_.meshes[placed.mesh])};
}

void InstanceComposer::add_instances() {
  const std::vector<glm::dmat4> at_start = from_.nodes.transforms(0);
  std::vector<glm::dmat4> places;
  for (const InstanceComposition::Placed& placed : from_.placed) {
    const Scene& of = from_.meshes[placed.mesh];
    places.push_back(at_start[placed.node] * from_offset(of));
    scene_.instances.push_back({placed.mesh, rounded(places.back(), glm::dvec3{0})});
    if (!of.camera || scene_.camera) continue;
    scene_.camera = moved_camera(*of.camera, places.back());
    if (of.motion) eye_ = {placed_at(placed), of.motion};
  }
  scene_.offset = find_offset(boxes_of_instances(scene_));
  move_camera(scene_, scene_.offset);
  if (scene_.offset == glm::dvec3{0}) return;
  for (std::size_t i = 0; i < places.size(); ++i)
    scene_.instances[i].transform = rounded(places[i], scene_.offset);
  scene_.warnings.push_back(describe_offset(scene_.offset));
}

void InstanceComposer::add_motion() {
  Motion motion;
  const auto rig = std::make_shared<InstanceRig>();
  for (std::uint32_t i = 0; i < from_.placed.size(); ++i) {
    if (moving_.index[from_.placed[i].node] < 0) continue;
    motion.moved_instances.push_back(i);
    rig->placed.push_back(placed_at(from_.placed[i]));
  }
  const bool camera_moves = from_.camera && from_.camera->moves();
  const bool deforms =
      std::ranges::any_of(from_.meshes, [](const Scene& mesh) { return mesh.motion != nullptr; });
  if (motion.moved_instances.empty() && !camera_moves && !deforms) return;
  rig->nodes = std::move(moving_.nodes);
  rig->camera = from_.camera;
  if (scene_.camera) rig->eye = std::move(eye_);
  rig->offset = scene_.offset;
  motion.rig = rig;
  motion.duration_seconds = from_.duration ? *from_.duration : duration_ > 0 ? duration_ : 1.0;
  motion.frames_per_second = from_.frames_per_second;
  scene_.motion = std::make_shared<Motion>(std::move(motion));
}

}  // namespace

Scene compose_instances(const InstanceComposition& composition) {
  return InstanceComposer(composition).compose();
}

}  // namespace coppice
