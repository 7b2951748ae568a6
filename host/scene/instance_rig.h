#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scene/gltf_rig.h"
#include "scene/scene_compose.h"

namespace coppice {

// What moves instances, each by itself, and the camera.
class InstanceRig : public Rig {
 public:
  struct Placed {
    std::uint32_t node;
    glm::dmat4 from_offset;
  };
  // The camera of a mesh that moves.
  struct Eye {
    Placed at;
    std::shared_ptr<const Motion> motion;
  };

  GltfRig nodes;
  std::vector<Placed> placed;  // one of Motion::moved_instances each
  std::optional<CameraTracks> camera;
  std::optional<Eye> eye;
  glm::dvec3 offset{0.0};  // subtracted from all that comes out

  Pose pose(double seconds) const override;  // of the camera; joints there are none
  std::vector<glm::dmat4> instances(double seconds) const override;
};

// The nodes that a track moves, or one of those above them, in as few nodes as that takes: what they hang
// from is still, a matrix.
struct MovingNodes {
  GltfRig nodes;
  std::vector<int> index;  // of each of all nodes its index in `nodes`; -1 where it stands still
};
MovingNodes moving_nodes(const GltfRig& all);

// A node that stands still there.
std::uint32_t add_still_node(GltfRig& nodes, const glm::dmat4& place);

}  // namespace coppice
