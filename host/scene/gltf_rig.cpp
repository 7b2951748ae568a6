#include "scene/gltf_rig.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace coppice {
namespace {

glm::dvec3 direction_or(glm::dvec3 direction, glm::dvec3 otherwise) {
  const double length = glm::length(direction);
  return length > 0 && std::isfinite(length) ? direction / length : otherwise;
}

}  // namespace

glm::dmat4 NodeTransform::matrix() const {
  if (is_matrix) return given;
  glm::dmat4 result = glm::mat4_cast(rotation);
  for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
  result[3] = glm::dvec4(translation, 1);
  return result;
}

double GltfRig::time_in_cycle(double seconds) const {
  if (!(duration > 0) || (seconds >= 0 && seconds <= duration)) return seconds;
  return seconds - std::floor(seconds / duration) * duration;
}

void GltfRig::apply_tracks(double seconds, std::vector<NodeTransform>& at) const {
  for (const NodeTrack& track : tracks) {
    if (track.path == NodePath::weights) continue;
    double value[4] = {};
    sample(track.keyframes, seconds, value);
    NodeTransform& node = at[track.node];
    if (track.path == NodePath::translation) node.translation = {value[0], value[1], value[2]};
    if (track.path == NodePath::scale) node.scale = {value[0], value[1], value[2]};
    if (track.path == NodePath::turn) node.rotation = glm::angleAxis(glm::radians(value[0]), track.axis);
    if (track.path == NodePath::rotation) node.rotation = {value[3], value[0], value[1], value[2]};
  }
}

std::vector<glm::dmat4> GltfRig::transforms(double seconds) const {
  std::vector<NodeTransform> at = nodes;
  apply_tracks(time_in_cycle(seconds), at);
  std::vector<glm::dmat4> result(nodes.size());
  for (const std::uint32_t node : order) {
    const glm::dmat4 own = at[node].matrix();
    result[node] = parents[node] < 0 ? own : result[static_cast<std::size_t>(parents[node])] * own;
  }
  return result;
}

Pose GltfRig::pose(double seconds) const {
  const std::vector<glm::dmat4> at = transforms(seconds);
  Pose pose;
  pose.joints.reserve(joints.size());
  for (const Joint& joint : joints) {
    pose.joints.emplace_back(joint.node < 0 ? joint.inverse_bind
                                            : at[static_cast<std::size_t>(joint.node)] * joint.inverse_bind);
  }
  pose.morph_weights.reserve(places.size());
  for (const Place& place : places) pose.morph_weights.push_back(static_cast<float>(place.weight));
  std::vector<double> weights;
  for (const NodeTrack& track : tracks) {
    if (track.path != NodePath::weights) continue;
    weights.resize(track.keyframes.width);
    sample(track.keyframes, time_in_cycle(seconds), weights);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i].node == track.node) pose.morph_weights[i] = static_cast<float>(weights[places[i].target]);
    }
  }
  if (eye.node >= 0) {
    pose.camera = camera_in(at[static_cast<std::size_t>(eye.node)], eye.distance, eye.vertical_fov_degrees);
  }
  return pose;
}

Camera camera_in(const glm::dmat4& transform, double distance, float vertical_fov_degrees) {
  const glm::dvec3 position(transform[3]);
  const glm::dvec3 forward = direction_or(-glm::dvec3(transform[2]), {0, 0, -1});
  Camera camera;
  camera.position = glm::vec3(position);
  camera.target = glm::vec3(position + distance * forward);
  camera.up = glm::vec3(direction_or(glm::dvec3(transform[1]), {0, 1, 0}));
  camera.vertical_fov_degrees = vertical_fov_degrees;
  return camera;
}

}  // namespace coppice
