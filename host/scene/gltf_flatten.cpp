#include "scene/gltf_flatten.h"

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numbers>

#include "scene/bounds.h"
#include "scene/corner_attributes.h"
#include "scene/gltf_animation.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_nodes.h"
#include "scene/printable.h"
#include "scene/scene_source.h"

namespace coppice {
namespace {

using namespace nlohmann::literals;

constexpr std::size_t MOST_JOINTS = 65536;  // what Motion::joints can name

// A vertex has one of each, where the primitive has them.
Scene corners_of_primitive(const GltfPrimitive& primitive) {
  Scene corners;
  corners.texcoords = primitive.texcoords;
  if (!corners.texcoords.empty()) corners.texcoord_index = primitive.triangles;
  corners.normals = primitive.normals;
  if (!corners.normals.empty()) corners.normal_index = primitive.triangles;
  return corners;
}

class GltfFlattener {
 public:
  GltfFlattener(const GltfDocument& document, const std::optional<std::string>& animation, glm::dvec3 offset)
      : document_(document),
        model_(document.model),
        accessors_(document),
        notes_(document.name),
        offset_(offset) {
    const GltfNodes nodes = read_gltf_nodes(document);
    rig_->nodes = nodes.transforms;
    rig_->parents = nodes.parents;
    rig_->order = nodes.order;
    drawn_ = nodes.drawn;
    rig_->tracks = read_gltf_tracks(document, accessors_, animation, notes_);
    has_joints_ = !rig_->tracks.empty() || !model_.skins.empty();
    find_what_moves();
    at_start_ = rig_->transforms(0);
  }

  Scene flatten();

 private:
  void find_what_moves();
  void add_mesh(std::uint32_t node);
  void add_primitive(std::uint32_t node, const GltfPrimitive& primitive, std::uint32_t joint,
                     bool is_skinned);
  void add_targets(std::uint32_t node, const GltfPrimitive& primitive, std::size_t first);
  void add_camera(std::uint32_t node);
  void look();
  double default_weight(std::uint32_t node, std::size_t target) const;
  std::uint32_t first_place(std::uint32_t node);
  std::uint32_t joint_of_node(std::uint32_t node);
  std::uint32_t joints_of_skin(int skin, const std::string& pointer);
  void check_room(std::size_t joints, const std::string& pointer) const;

  const GltfDocument& document_;
  const tinygltf::Model& model_;
  GltfAccessors accessors_;
  SceneNotes notes_;
  glm::dvec3 offset_;
  std::vector<std::uint32_t> drawn_;
  std::shared_ptr<GltfRig> rig_ = std::make_shared<GltfRig>();
  std::vector<bool> moves_, morphs_;  // of each node: itself or a parent; its weights
  bool has_joints_;
  std::vector<glm::dmat4> at_start_;
  std::map<int, std::uint32_t> first_joint_of_skin_;
  Scene scene_;
  Motion motion_;
};

void GltfFlattener::find_what_moves() {
  moves_.assign(rig_->nodes.size(), false);
  morphs_ = moves_;
  for (const NodeTrack& track : rig_->tracks) {
    (track.path == NodePath::weights ? morphs_ : moves_)[track.node] = true;
    rig_->duration = std::max(rig_->duration, track.keyframes.times.back());
  }
  for (const std::uint32_t node : rig_->order) {
    const int parent = rig_->parents[node];
    if (parent >= 0 && moves_[static_cast<std::size_t>(parent)]) moves_[node] = true;
  }
}

void GltfFlattener::check_room(std::size_t joints, const std::string& pointer) const {
  if (rig_->joints.size() + joints <= MOST_JOINTS) return;
  document_.fail(pointer, "more than " + std::to_string(MOST_JOINTS) +
                              " joints and moving nodes with a mesh, expected no more");
}

std::uint32_t GltfFlattener::joint_of_node(std::uint32_t node) {
  if (!moves_[node] && !morphs_[node]) return 0;
  check_room(1, "/nodes/" + std::to_string(node));
  rig_->joints.push_back({static_cast<int>(node), glm::dmat4(1.0)});
  return static_cast<std::uint32_t>(rig_->joints.size() - 1);
}

std::uint32_t GltfFlattener::joints_of_skin(int index, const std::string& pointer) {
  document_.check_index(pointer, index, model_.skins.size(), "skins");
  const auto known = first_joint_of_skin_.find(index);
  if (known != first_joint_of_skin_.end()) return known->second;
  const tinygltf::Skin& skin = model_.skins[static_cast<std::size_t>(index)];
  const std::string skin_pointer = "/skins/" + std::to_string(index);
  std::vector<float> inverse;
  if (skin.inverseBindMatrices >= 0) {
    const std::string user = skin_pointer + "/inverseBindMatrices";
    inverse = accessors_.floats(skin.inverseBindMatrices, "MAT4", user);
    if (inverse.size() / 16 < skin.joints.size()) {
      document_.fail("/accessors/" + std::to_string(skin.inverseBindMatrices) + "/count",
                     std::to_string(inverse.size() / 16) + ", expected at least the " +
                         std::to_string(skin.joints.size()) + " joints of " + skin_pointer);
    }
  }
  check_room(skin.joints.size(), skin_pointer);
  const auto first = static_cast<std::uint32_t>(rig_->joints.size());
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    document_.check_index(skin_pointer + "/joints/" + std::to_string(i), skin.joints[i], model_.nodes.size(),
                          "nodes");
    GltfRig::Joint joint{skin.joints[i], glm::dmat4(1.0)};
    for (std::size_t k = 0; k < 16 && !inverse.empty(); ++k) {
      joint.inverse_bind[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = inverse[16 * i + k];
    }
    for (int column = 0; column < 4; ++column) joint.inverse_bind[column][3] = column == 3 ? 1.0 : 0.0;
    rig_->joints.push_back(joint);
  }
  first_joint_of_skin_[index] = first;
  return first;
}

double GltfFlattener::default_weight(std::uint32_t node, std::size_t target) const {
  const tinygltf::Node& from = model_.nodes[node];
  const std::vector<double>& of_mesh = model_.meshes[static_cast<std::size_t>(from.mesh)].weights;
  const std::vector<double>& weights = from.weights.empty() ? of_mesh : from.weights;
  return target < weights.size() ? weights[target] : 0.0;
}

// The places of a node's animated weights in Pose::morph_weights.
std::uint32_t GltfFlattener::first_place(std::uint32_t node) {
  for (std::size_t i = 0; i < rig_->places.size(); ++i) {
    if (rig_->places[i].node == node) return static_cast<std::uint32_t>(i);
  }
  const auto first = static_cast<std::uint32_t>(rig_->places.size());
  for (std::uint32_t target = 0; target < target_count(document_, node); ++target) {
    rig_->places.push_back({node, target, default_weight(node, target)});
  }
  return first;
}

void GltfFlattener::add_targets(std::uint32_t node, const GltfPrimitive& primitive, std::size_t first) {
  for (std::uint32_t i = 0; i < primitive.targets.size(); ++i) {
    if (primitive.targets[i].empty()) continue;
    motion_.morphs.push_back(
        {{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(primitive.positions.size())},
         first_place(node) + i,
         primitive.targets[i]});
  }
}

void GltfFlattener::add_primitive(std::uint32_t node, const GltfPrimitive& primitive, std::uint32_t joint,
                                  bool is_skinned) {
  const std::size_t first = motion_.rest.size(), count = primitive.positions.size();
  if (scene_.indices.size() + primitive.triangles.size() > MAX_GENERATED_TRIANGLES ||
      first + count > UINT32_MAX) {
    document_.fail("/nodes/" + std::to_string(node) + "/mesh", "the scene comes to more than " +
                                                                   std::to_string(MAX_GENERATED_TRIANGLES) +
                                                                   " triangles, expected no more");
  }
  const bool stands_still = joint == 0 && !is_skinned;
  const glm::dmat4& to_scene = at_start_[node];
  std::vector<std::pair<double, const std::vector<glm::vec3>*>> added;  // morph targets that stay as they are
  for (std::size_t i = 0; i < primitive.targets.size() && !morphs_[node]; ++i) {
    const double weight = default_weight(node, i);
    if (weight != 0 && !primitive.targets[i].empty()) added.emplace_back(weight, &primitive.targets[i]);
  }
  for (std::size_t v = 0; v < count; ++v) {
    glm::dvec3 position = primitive.positions[v];
    for (const auto& [weight, offsets] : added) position += weight * glm::dvec3((*offsets)[v]);
    if (stands_still) position = glm::dvec3(to_scene * glm::dvec4(position, 1)) - offset_;
    motion_.rest.emplace_back(position);
  }
  const bool is_mirrored = !is_skinned && glm::determinant(glm::dmat3(to_scene)) < 0;
  const auto base = static_cast<std::uint32_t>(first);
  for (const glm::uvec3 triangle : primitive.triangles) {
    scene_.indices.push_back(base +
                             (is_mirrored ? glm::uvec3(triangle.x, triangle.z, triangle.y) : triangle));
  }
  scene_.material_index.resize(scene_.indices.size(), primitive.material);
  const bool keeps_normals = stands_still && added.empty() && !morphs_[node];
  append_corner_attributes(corners_of_primitive(primitive), 0, primitive.triangles.size(),
                           {to_scene, is_mirrored, keeps_normals}, scene_);
  for (std::size_t v = 0; v < count && has_joints_; ++v) {
    const auto at = [&](std::size_t k) {
      return static_cast<std::uint16_t>(joint + (is_skinned ? primitive.joints[v][k] : 0));
    };
    motion_.joints.push_back(is_skinned ? std::array{at(0), at(1), at(2), at(3)}
                                        : std::array{at(0), at(0), at(0), at(0)});
    motion_.weights.push_back(is_skinned ? primitive.weights[v] : glm::vec4(1, 0, 0, 0));
  }
  if (morphs_[node]) add_targets(node, primitive, first);
}

void GltfFlattener::add_mesh(std::uint32_t node) {
  const tinygltf::Node& from = model_.nodes[node];
  const std::string pointer = "/nodes/" + std::to_string(node);
  document_.check_index(pointer + "/mesh", from.mesh, model_.meshes.size(), "meshes");
  target_count(document_, node);  // the same in all primitives
  const bool is_skinned = from.skin >= 0;
  const std::uint32_t joint = is_skinned ? joints_of_skin(from.skin, pointer + "/skin") : joint_of_node(node);
  const std::size_t skin_joints =
      is_skinned ? model_.skins[static_cast<std::size_t>(from.skin)].joints.size() : 0;
  const auto mesh = static_cast<std::size_t>(from.mesh);
  for (std::size_t i = 0; i < model_.meshes[mesh].primitives.size(); ++i) {
    add_primitive(node, read_gltf_primitive(document_, accessors_, mesh, i, skin_joints, notes_), joint,
                  is_skinned);
  }
}

void GltfFlattener::add_camera(std::uint32_t node) {
  const int index = model_.nodes[node].camera;
  const std::size_t count = document_.json.contains("cameras") ? document_.json["cameras"].size() : 0;
  document_.check_index("/nodes/" + std::to_string(node) + "/camera", index, count, "cameras");
  const nlohmann::json& camera = document_.json["cameras"][static_cast<std::size_t>(index)];
  const std::string pointer = "/cameras/" + std::to_string(index);
  if (camera["type"] != "perspective") {
    notes_.add(pointer, "orthographic cameras are not used");
    return;
  }
  if (!camera.contains("perspective"))
    document_.fail(pointer, "key \"perspective\" is missing, it is required here");
  if (rig_->eye.node >= 0) return;
  rig_->eye.node = static_cast<int>(node);
  rig_->eye.vertical_fov_degrees =
      static_cast<float>(camera["perspective"]["yfov"].get<double>() * 180 / std::numbers::pi);
}

Scene GltfFlattener::flatten() {
  for (const std::uint32_t node : drawn_) {
    if (model_.nodes[node].camera >= 0) add_camera(node);
    if (model_.nodes[node].mesh >= 0) add_mesh(node);
  }
  scene_.materials = read_gltf_materials(document_, notes_);
  if (document_.json.contains("/extensions/KHR_lights_punctual"_json_pointer)) {
    notes_.add("/extensions/KHR_lights_punctual", "lights are not used");
  }
  if (scene_.indices.empty()) notes_.add("", "no triangles");
  motion_.rig = rig_;
  if (has_joints_) {
    scene_.positions = positions_at(motion_, 0);
  } else {
    scene_.positions = std::move(motion_.rest);
  }
  if (rig_->eye.node >= 0) look();
  scene_.offset = offset_;
  scene_.warnings = notes_.lines();
  if (rig_->duration > 0) {
    motion_.duration_seconds = rig_->duration;
    scene_.motion = std::make_shared<Motion>(std::move(motion_));
  }
  return std::move(scene_);
}

// The scene's camera, whose target is as far as the middle of what it may see.
void GltfFlattener::look() {
  GltfRig::Eye& eye = rig_->eye;
  glm::dmat4 at = at_start_[static_cast<std::size_t>(eye.node)];
  at[3] -= glm::dvec4(offset_, 0);
  const Camera unit = camera_in(glm::dmat4(glm::dmat3(at)), 1, eye.vertical_fov_degrees);
  const Bounds bounds = visible_bounds(scene_);
  const double ahead = glm::dot(bounds.centre() - glm::dvec3(at[3]), glm::dvec3(unit.target));
  const double least = std::max(0.1 * bounds.extent(), 1e-30);
  eye.distance = std::isfinite(ahead) && ahead > least ? ahead : bounds.extent() > 0 ? bounds.extent() : 1.0;
  scene_.camera = camera_in(at, eye.distance, eye.vertical_fov_degrees);
  const bool is_sound = is_finite(scene_.camera->position) && is_finite(scene_.camera->target);
  if (!is_sound) {
    notes_.add("/nodes/" + std::to_string(eye.node),
               "a camera that is not in the range of float is not used");
    scene_.camera.reset();
  }
  if (!is_sound || !moves_[static_cast<std::size_t>(eye.node)]) eye.node = -1;
}

}  // namespace

Scene flatten_gltf(const GltfDocument& document, const std::optional<std::string>& animation,
                   glm::dvec3 offset) {
  return GltfFlattener(document, animation, offset).flatten();
}

}  // namespace coppice
