#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace coppice {

// How the vertices of a moving scene get from where they lie at rest to where they are at a time. In this
// order, each part for a range of vertices: a sequence replaces their positions, morph targets are added, a
// deformation bends them, and the four joints of each take them into the scene. Kernels of the same names do
// it on the device; positions_at does it on the host, in double.

struct VertexRange {
  std::uint32_t first = 0, count = 0;
};

// Positions that were simulated or scanned, frame by frame.
struct VertexSequence {
  VertexRange vertices;
  double first_second = 0;        // of frame 0
  double frames_per_second = 30;  // positive
  bool interpolates = false;      // else the frame before a time holds until the next one
  // frame * vertices.count + vertex; at least one frame. Before the first and after the last frame that one
  // holds, unless the sequence repeats.
  bool repeats = false;
  std::vector<glm::vec3> positions{};

  std::uint32_t frame_count() const {
    return vertices.count == 0 ? 0 : static_cast<std::uint32_t>(positions.size() / vertices.count);
  }
};

// One morph target (glTF 2.0, 3.7.2.2): offsets of positions, added with the weight of its place.
struct MorphTarget {
  VertexRange vertices;
  std::uint32_t weight = 0;          // index into Pose::morph_weights
  std::vector<glm::vec3> offsets{};  // one a vertex
};

// Between which frames a time lies, and which part of the way from the first of them to the second.
struct SequenceTime {
  std::uint32_t frame, next_frame;
  float part;  // 0 where the sequence does not interpolate; below 1
};
SequenceTime time_in(const VertexSequence& sequence, double seconds);

enum class DeformKind : std::uint32_t {
  wave,     // up and down along +y: two plane waves that cross
  twist,    // around the axis y, back and forth, by the height
  explode,  // pieces fly apart from the centre, tumble and come back
  swarm,    // pieces circle the axis y, each at a speed of its own
  sway,     // bends in the wind, the more the higher a vertex lies over the centre
  // Of twist, explode and sway all vertices are at rest at second 0.
};

// A deformation that a kernel computes from the time alone.
struct Deformation {
  VertexRange vertices;
  DeformKind kind = DeformKind::wave;
  std::uint32_t piece_vertices = 3;  // explode, swarm: so many vertices that follow each other move as one
  glm::vec3 centre{0.0f};            // through which the axis goes
  float size = 1.0f;                 // of what is deformed, about its greatest extent; positive
  float amount = 0.1f;               // in parts of the size; twist: turns from the bottom to the top
  float seconds = 2.0f;              // a whole cycle; positive
};

// The part of a cycle at that time, from 0 to 1.
float phase_of(const Deformation& deformation, double seconds);

// What the frame of a time needs beside the vertices at rest.
struct Pose {
  std::vector<glm::mat4> joints;     // from the space of rest to the scene; the last row is 0 0 0 1
  std::vector<float> morph_weights;  // one a place
  std::optional<Camera> camera;      // where it moves, too
};

// What moves joints, weights and the camera: rigid keyframes, the nodes of a glTF file.
class Rig {
 public:
  virtual ~Rig() = default;
  virtual Pose pose(double seconds) const = 0;  // a pure function; every time has one
  // Where Motion::moved_instances are, from the spaces of their meshes.
  virtual std::vector<glm::dmat4> instances(double) const { return {}; }
};

// What moves in a scene, or could: Scene::positions are those at second 0.
struct Motion {
  std::vector<glm::vec3> rest;  // one a vertex of the scene
  std::vector<VertexSequence> sequences;
  std::vector<MorphTarget> morphs;
  std::vector<Deformation> deformations;
  // One of each a vertex; both empty where all of a vertex goes by joint 0.
  std::vector<std::array<std::uint16_t, 4>> joints;  // into Pose::joints
  std::vector<glm::vec4> weights;
  std::shared_ptr<const Rig> rig;  // null: one joint that stands still
  // Of a scene with instances: those that the rig moves, in rising order, and no vertices.
  std::vector<std::uint32_t> moved_instances;
  // From where the rig takes vertices to the coordinates of the scene (stand_up, bring_into_range).
  glm::dmat4 to_scene{1.0};
  double duration_seconds = 1;    // of one cycle; positive
  double frames_per_second = 30;  // that the scene asks for; positive
};

// A cycle of what moves in a scene, a swarm of instances too; none where nothing does.
struct SceneCycle {
  double seconds, frames_per_second;
};
std::optional<SceneCycle> cycle_of(const Scene& scene);

// Of a scene without motion, too: one joint that stands still.
Motion motion_of(const Scene& scene);

// The pose with to_scene applied to joints and camera. At least one joint.
Pose pose_at(const Motion& motion, double seconds);

// Where moved_instances are at that time: computed in double, rounded once.
std::vector<glm::mat4x3> instances_at(const Motion& motion, double seconds);

// Where the vertices are at that time: computed in double, rounded once.
std::vector<glm::vec3> positions_at(const Motion& motion, double seconds);

}  // namespace coppice
