#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <vector>

#include "scene/keyframes.h"
#include "scene/motion.h"

namespace coppice {

// Translation, rotation and scale in this order, or a matrix.
struct NodeTransform {
  bool is_matrix = false;
  glm::dmat4 given{1.0};
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};

  glm::dmat4 matrix() const;
};

enum class NodePath { translation, rotation, scale, weights, turn };  // turn: degrees around an axis

struct NodeTrack {
  std::uint32_t node = 0;
  NodePath path = NodePath::translation;
  Keyframes keyframes;
  glm::dvec3 axis{0.0, 1.0, 0.0};  // of a turn; unit length
};

// The nodes of a glTF file in motion. A time before 0 or after the end of the animation is one of the cycle
// that repeats it.
class GltfRig : public Rig {
 public:
  struct Joint {
    int node = -1;  // none: stands still
    glm::dmat4 inverse_bind{1.0};
  };
  // One morph target of one node.
  struct Place {
    std::uint32_t node = 0, target = 0;
    double weight = 0;  // where no track sets it
  };
  struct Eye {
    int node = -1;        // none: no camera that moves
    double distance = 1;  // to the target
    float vertical_fov_degrees = 40;
  };

  std::vector<NodeTransform> nodes;
  std::vector<int> parents;          // a node, or -1
  std::vector<std::uint32_t> order;  // parents come before children
  std::vector<NodeTrack> tracks;
  std::vector<Joint> joints = {{}};  // the first stands still
  std::vector<Place> places;
  Eye eye;
  double duration = 0;

  Pose pose(double seconds) const override;

  // From each node to the scene.
  std::vector<glm::dmat4> transforms(double seconds) const;

 private:
  double time_in_cycle(double seconds) const;
  void apply_tracks(double seconds, std::vector<NodeTransform>& at) const;
};

// What a camera sees whose space a matrix brings to the scene: it looks along -z, +y is up
// (glTF 2.0, 3.10.2).
Camera camera_in(const glm::dmat4& transform, double distance, float vertical_fov_degrees);

}  // namespace coppice
