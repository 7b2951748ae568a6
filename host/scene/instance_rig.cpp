#include "scene/instance_rig.h"

#include <map>

namespace coppice {
namespace {

Camera moved_back(Camera camera, glm::dvec3 offset) {
  camera.position = glm::vec3(glm::dvec3(camera.position) - offset);
  camera.target = glm::vec3(glm::dvec3(camera.target) - offset);
  return camera;
}

std::vector<bool> nodes_that_move(const GltfRig& all) {
  std::vector<bool> moves(all.nodes.size());
  for (const NodeTrack& track : all.tracks) moves[track.node] = true;
  for (const std::uint32_t node : all.order) {
    const int parent = all.parents[node];
    if (parent >= 0 && moves[static_cast<std::size_t>(parent)]) moves[node] = true;
  }
  return moves;
}

}  // namespace

Pose InstanceRig::pose(double seconds) const {
  Pose result;
  if (camera && camera->moves()) {
    result.camera = moved_back(camera->at(seconds), offset);
  } else if (eye) {
    const Pose own = pose_at(*eye->motion, seconds);
    const glm::dmat4 place = nodes.transforms(seconds)[eye->at.node] * eye->at.from_offset;
    if (own.camera) result.camera = moved_back(moved_camera(*own.camera, place), offset);
  }
  return result;
}

std::vector<glm::dmat4> InstanceRig::instances(double seconds) const {
  const std::vector<glm::dmat4> at = nodes.transforms(seconds);
  std::vector<glm::dmat4> result;
  result.reserve(placed.size());
  for (const Placed& one : placed) {
    glm::dmat4& place = result.emplace_back(at[one.node] * one.from_offset);
    place[3] -= glm::dvec4(offset, 0);
  }
  return result;
}

MovingNodes moving_nodes(const GltfRig& all) {
  const std::vector<bool> moves = nodes_that_move(all);
  const std::vector<glm::dmat4> at_start = all.transforms(0);
  MovingNodes result;
  result.index.assign(all.nodes.size(), -1);
  std::map<int, int> still;  // by the node that something hangs from
  for (const std::uint32_t node : all.order) {
    if (!moves[node]) continue;
    int parent = all.parents[node];
    if (parent >= 0 && moves[static_cast<std::size_t>(parent)]) {
      parent = result.index[static_cast<std::size_t>(parent)];
    } else if (parent >= 0) {
      const auto [known, is_new] = still.try_emplace(parent);
      if (is_new)
        known->second =
            static_cast<int>(add_still_node(result.nodes, at_start[static_cast<std::size_t>(parent)]));
      parent = known->second;
    }
    result.index[node] = static_cast<int>(result.nodes.nodes.size());
    result.nodes.order.push_back(static_cast<std::uint32_t>(result.nodes.nodes.size()));
    result.nodes.nodes.push_back(all.nodes[node]);
    result.nodes.parents.push_back(parent);
  }
  for (NodeTrack track : all.tracks) {
    track.node = static_cast<std::uint32_t>(result.index[track.node]);
    result.nodes.tracks.push_back(std::move(track));
  }
  return result;
}

std::uint32_t add_still_node(GltfRig& nodes, const glm::dmat4& place) {
  const auto index = static_cast<std::uint32_t>(nodes.nodes.size());
  NodeTransform transform;
  transform.is_matrix = true;
  transform.given = place;
  nodes.nodes.push_back(transform);
  nodes.parents.push_back(-1);
  nodes.order.push_back(index);
  return index;
}

}  // namespace coppice
