#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scene/gltf_rig.h"
#include "scene/motion.h"
#include "scene/scene.h"

namespace coppice {

// A scene as a part of another one.
struct ScenePart {
  Scene scene;                             // stood up, not brought into range
  std::uint32_t node = 0;                  // of the nodes that it is composed with
  std::optional<Deformation> deformation;  // of all its vertices; vertices is not used
};

// A camera that keyframes move. Each track may be empty; then the still camera's value holds.
struct CameraTracks {
  Camera still;
  std::optional<Keyframes> position, target, up, fov;

  bool moves() const { return position || target || up || fov; }
  Camera at(double seconds) const;
  double end() const;  // of the longest track
};

// Where the parts go: nodes in the scene and what moves them.
struct Composition {
  GltfRig nodes;  // nodes, parents, order and tracks of it
  std::vector<ScenePart> parts;
  std::optional<CameraTracks> camera;  // else that of the first part that has one
  double frames_per_second = 30;
  std::optional<double> duration;  // else that of the longest part
};

// One scene of all parts. What stands still keeps its place within float; what moves has a joint a node or as
// many as its part has, and no normals. There is a motion if anything moves. Throws InputError where there
// are more triangles or joints than a scene can have; the message is without a file.
Scene compose(Composition composition);

// Meshes, once each, and where they are placed.
struct InstanceComposition {
  struct Placed {
    std::uint32_t mesh;  // into meshes
    std::uint32_t node;
  };
  GltfRig nodes;              // nodes, parents, order and tracks of it
  std::vector<Scene> meshes;  // stood up, not brought into range
  std::vector<Placed> placed;
  std::optional<CameraTracks> camera{};  // else that of the first placed mesh that has one
  double frames_per_second = 30;
  std::optional<double> duration{};  // else that of what takes longest
};

// One scene with all of them as instances, near the origin if they are far from it for their size. A mesh
// that has a motion keeps it; there is a motion of the scene if a mesh has one, or instances or the camera
// move. Throws InputError, without a file, for more triangles than a scene can have.
Scene compose_instances(const InstanceComposition& composition);

// From a part's coordinates, of which an offset may have been subtracted.
glm::dmat4 from_offset(const Scene& scene);

Camera moved_camera(const Camera& camera, const glm::dmat4& by);

// Every triangle with vertices of its own, in order. The scene has no motion.
void unshare_vertices(Scene& scene);

}  // namespace coppice
