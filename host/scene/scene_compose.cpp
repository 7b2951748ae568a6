#include "scene/scene_compose.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scene/bounds.h"
#include "scene/corner_attributes.h"
#include "scene/input_error.h"
#include "scene/obj_offset.h"
#include "scene/scene_source.h"

namespace coppice {
namespace {

constexpr std::size_t MOST_COMPOSED_JOINTS = 65536;  // what Motion::joints can name

// The rigs of the parts, each below its node. Joint 0 stands still.
class ComposedRig : public Rig {
 public:
  struct Part {
    std::uint32_t node;
    glm::dmat4 from_offset;
    std::shared_ptr<const Motion> motion;  // null: goes with its node
    bool gives_camera = false;
  };
  GltfRig nodes;
  std::vector<Part> parts;  // those that move
  std::optional<CameraTracks> camera;

  Pose pose(double seconds) const override {
    const std::vector<glm::dmat4> at = nodes.transforms(seconds);
    Pose result;
    result.joints.emplace_back(1.0f);
    for (const Part& part : parts) {
      const glm::dmat4 place = at[part.node] * part.from_offset;
      if (!part.motion) {
        result.joints.emplace_back(place);
        continue;
      }
      const Pose own = pose_at(*part.motion, seconds);
      for (const glm::mat4& joint : own.joints) result.joints.emplace_back(place * glm::dmat4(joint));
      result.morph_weights.insert(result.morph_weights.end(), own.morph_weights.begin(),
                                  own.morph_weights.end());
      if (part.gives_camera && own.camera) result.camera = moved_camera(*own.camera, place);
    }
    if (camera && camera->moves()) result.camera = camera->at(seconds);
    return result;
  }
};

class Composer {
 public:
  explicit Composer(Composition composition) : from_(std::move(composition)) {}
  Scene compose() {
    Scene scene = compose_with(glm::dvec3{0});
    if (scene.motion) return scene;
    const glm::dvec3 offset = find_offset(scene);
    if (offset == glm::dvec3{0}) return scene;
    scene = compose_with(offset);
    scene.warnings.push_back(describe_offset(offset));
    return scene;
  }

 private:
  Scene compose_with(glm::dvec3 offset);
  void add(const ScenePart& part, const glm::dmat4& place);
  void add_still(const Scene& scene, const glm::dmat4& place);
  void add_moving(const ScenePart& part);
  void add_motion(const Motion& motion, std::uint32_t first, std::uint32_t joint, std::uint32_t weight);
  void add_joints(std::size_t count, std::uint16_t joint) {
    if (!has_joints_) return;
    motion_.joints.insert(motion_.joints.end(), count, {joint, joint, joint, joint});
    motion_.weights.insert(motion_.weights.end(), count, glm::vec4(1, 0, 0, 0));
  }
  void find_what_moves();
  void add_camera();

  Composition from_;
  glm::dvec3 offset_{0};
  std::vector<bool> moves_;  // of each node
  bool has_joints_ = false;  // anything moves
  std::shared_ptr<ComposedRig> rig_;
  Motion motion_;
  Scene scene_;
  std::size_t joint_count_ = 1, weight_count_ = 0;
  double duration_ = 0;
};

void Composer::find_what_moves() {
  moves_.assign(from_.nodes.nodes.size(), false);
  for (const NodeTrack& track : from_.nodes.tracks) {
    moves_[track.node] = true;
    duration_ = std::max(duration_, track.keyframes.times.back());
  }
  has_joints_ = !from_.nodes.tracks.empty();
  for (const ScenePart& part : from_.parts) has_joints_ |= part.scene.motion || part.deformation;
  for (const std::uint32_t node : from_.nodes.order) {
    const int parent = from_.nodes.parents[node];
    if (parent >= 0 && moves_[static_cast<std::size_t>(parent)]) moves_[node] = true;
  }
}

void Composer::add_still(const Scene& scene, const glm::dmat4& place) {
  const glm::dmat4 to_scene = place * from_offset(scene);
  for (const glm::vec3 position : scene.positions) {
    motion_.rest.emplace_back(glm::dvec3(to_scene * glm::dvec4(position, 1)) - offset_);
  }
  add_joints(scene.positions.size(), 0);
}

void Composer::add_motion(const Motion& motion, std::uint32_t first, std::uint32_t joint,
                          std::uint32_t weight) {
  motion_.rest.insert(motion_.rest.end(), motion.rest.begin(), motion.rest.end());
  for (VertexSequence sequence : motion.sequences) {
    sequence.vertices.first += first;
    motion_.sequences.push_back(std::move(sequence));
  }
  for (MorphTarget morph : motion.morphs) {
    morph.vertices.first += first;
    morph.weight += weight;
    motion_.morphs.push_back(std::move(morph));
  }
  for (Deformation deformation : motion.deformations) {
    deformation.vertices.first += first;
    motion_.deformations.push_back(deformation);
  }
  if (motion.joints.empty()) return add_joints(motion.rest.size(), static_cast<std::uint16_t>(joint));
  for (const auto& joints : motion.joints) {
    auto& added = motion_.joints.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) added[k] = static_cast<std::uint16_t>(joints[k] + joint);
  }
  motion_.weights.insert(motion_.weights.end(), motion.weights.begin(), motion.weights.end());
}

void Composer::add_moving(const ScenePart& part) {
  const Scene& scene = part.scene;
  const auto first = static_cast<std::uint32_t>(motion_.rest.size());
  const auto joint = static_cast<std::uint32_t>(joint_count_);
  if (scene.motion) {
    const Pose pose = pose_at(*scene.motion, 0);
    joint_count_ += pose.joints.size();
    if (joint_count_ <= MOST_COMPOSED_JOINTS) {
      add_motion(*scene.motion, first, joint, static_cast<std::uint32_t>(weight_count_));
    }
    weight_count_ += pose.morph_weights.size();
    duration_ = std::max(duration_, scene.motion->duration_seconds);
  } else {
    ++joint_count_;
    motion_.rest.insert(motion_.rest.end(), scene.positions.begin(), scene.positions.end());
    add_joints(scene.positions.size(), static_cast<std::uint16_t>(joint));
  }
  if (joint_count_ > MOST_COMPOSED_JOINTS) {
    throw InputError("objects that move come to more than " + std::to_string(MOST_COMPOSED_JOINTS) +
                     " joints");
  }
  if (part.deformation) {
    Deformation deformation = *part.deformation;
    deformation.vertices = {first, static_cast<std::uint32_t>(scene.positions.size())};
    motion_.deformations.push_back(deformation);
    duration_ = std::max(duration_, double{deformation.seconds});
  }
  rig_->parts.push_back({part.node, from_offset(scene), scene.motion, false});
}

void Composer::add(const ScenePart& part, const glm::dmat4& place) {
  const Scene& scene = part.scene;
  const std::size_t first = motion_.rest.size();
  if (scene_.indices.size() + scene.indices.size() > MAX_GENERATED_TRIANGLES ||
      first + scene.positions.size() > UINT32_MAX) {
    throw InputError("objects come to more than " + std::to_string(MAX_GENERATED_TRIANGLES) + " triangles");
  }
  if (moves_[part.node] || scene.motion || part.deformation) {
    add_moving(part);
  } else {
    add_still(scene, place);
  }
  const bool is_mirrored = glm::determinant(glm::dmat3(place)) < 0;
  for (const glm::uvec3 t : scene.indices) {
    scene_.indices.push_back(static_cast<std::uint32_t>(first) +
                             (is_mirrored ? glm::uvec3(t.x, t.z, t.y) : t));
  }
  const bool stands_still = !(moves_[part.node] || scene.motion || part.deformation);
  append_corner_attributes(scene, 0, scene.indices.size(), {place, is_mirrored, stands_still}, scene_);
  const auto first_material = static_cast<std::uint32_t>(scene_.materials.size());
  for (const std::uint32_t index : scene.material_index)
    scene_.material_index.push_back(first_material + index);
  scene_.materials.insert(scene_.materials.end(), scene.materials.begin(), scene.materials.end());
  if (scene.camera && !scene_.camera && !from_.camera) {
    scene_.camera = moved_camera(*scene.camera, place * from_offset(scene));
    scene_.camera->position = glm::vec3(glm::dvec3(scene_.camera->position) - offset_);
    scene_.camera->target = glm::vec3(glm::dvec3(scene_.camera->target) - offset_);
    if (!is_finite(scene_.camera->position) || !is_finite(scene_.camera->target)) {
      scene_.camera.reset();
    } else if (scene.motion) {
      rig_->parts.back().gives_camera = true;
    }
  }
}

void Composer::add_camera() {
  if (!from_.camera) return;
  scene_.camera = from_.camera->at(0);
  if (from_.camera->moves()) return;
  scene_.camera->position = glm::vec3(glm::dvec3(scene_.camera->position) - offset_);
  scene_.camera->target = glm::vec3(glm::dvec3(scene_.camera->target) - offset_);
}

Scene Composer::compose_with(glm::dvec3 offset) {
  offset_ = offset;
  rig_ = std::make_shared<ComposedRig>();
  motion_ = {};
  scene_ = {};
  joint_count_ = 1;
  weight_count_ = 0;
  duration_ = 0;
  find_what_moves();
  const std::vector<glm::dmat4> at_start = from_.nodes.transforms(0);
  for (const ScenePart& part : from_.parts) add(part, at_start[part.node]);
  add_camera();
  bool moves = !rig_->parts.empty();
  if (from_.camera && from_.camera->moves()) {
    moves = true;
    duration_ = std::max(duration_, from_.camera->end());
  }
  if (!moves) {
    scene_.positions = std::move(motion_.rest);
    scene_.offset = offset;
    return std::move(scene_);
  }
  rig_->nodes = from_.nodes;
  rig_->camera = from_.camera;
  motion_.rig = rig_;
  motion_.duration_seconds = from_.duration ? *from_.duration : duration_ > 0 ? duration_ : 1.0;
  motion_.frames_per_second = from_.frames_per_second;
  scene_.positions = positions_at(motion_, 0);
  scene_.motion = std::make_shared<Motion>(std::move(motion_));
  return std::move(scene_);
}

}  // namespace

Camera CameraTracks::at(double seconds) const {
  Camera camera = still;
  const auto take = [&](const std::optional<Keyframes>& track, glm::vec3& value) {
    if (!track) return;
    double sampled[3];
    sample(*track, seconds, sampled);
    value = {sampled[0], sampled[1], sampled[2]};
  };
  take(position, camera.position);
  take(target, camera.target);
  take(up, camera.up);
  if (fov) {
    double degrees[1];
    sample(*fov, seconds, degrees);
    camera.vertical_fov_degrees = static_cast<float>(std::clamp(degrees[0], 0.01, 179.0));
  }
  return camera;
}

double CameraTracks::end() const {
  double end = 0;
  for (const auto* track : {&position, &target, &up, &fov}) {
    if (*track) end = std::max(end, (*track)->times.back());
  }
  return end;
}

glm::dmat4 from_offset(const Scene& scene) {
  glm::dmat4 result(1.0);
  result[3] = glm::dvec4(direction_to_scene(scene, scene.offset), 1);
  return result;
}

Camera moved_camera(const Camera& camera, const glm::dmat4& by) {
  Camera result = camera;
  result.position = glm::vec3(by * glm::dvec4(camera.position, 1));
  result.target = glm::vec3(by * glm::dvec4(camera.target, 1));
  const glm::dvec3 up = glm::dmat3(by) * glm::dvec3(camera.up);
  const double length = glm::length(up);
  if (length > 0 && std::isfinite(length)) result.up = glm::vec3(up / length);
  return result;
}

Scene compose(Composition composition) { return Composer(std::move(composition)).compose(); }

void unshare_vertices(Scene& scene) {
  std::vector<glm::vec3> positions;
  positions.reserve(3 * scene.indices.size());
  for (glm::uvec3& triangle : scene.indices) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (int corner = 0; corner < 3; ++corner) positions.push_back(scene.positions[triangle[corner]]);
    triangle = {first, first + 1, first + 2};
  }
  scene.positions = std::move(positions);
}

}  // namespace coppice
