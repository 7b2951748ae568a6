#pragma once

#include <optional>
#include <vector>

#include "render/frame.h"
#include "render/moving_vertices.h"
#include "scene/instances.h"

namespace coppice {

// What moves of a scene with instances: transforms of a swarm, those that keyframes move, and meshes that
// deform. What stands still is as it was before the first frame: a mesh's tree, and all if nothing moves.
struct MovingInstances {
  struct Mesh {
    std::uint32_t mesh;  // into Scene::meshes
    MovingVertices vertices;
    RefitPlan refit;  // empty where no frame is refitted
  };

  std::vector<Mesh> meshes;           // those that deform
  std::uint32_t first_moved = 0;      // from the first instance that keyframes move
  std::uint32_t moved_count = 0;      // to the last one, whatever lies between them
  Slot<InstanceTransform> rest;       // of a swarm
  std::optional<TopRefit> top;        // where frames are refitted
  Slot<RefitState> mesh_refits;       // one of each of `meshes`, where frames are refitted
  std::optional<std::uint32_t> seed;  // of a swarm

  bool moves() const { return seed || moved_count > 0 || !meshes.empty(); }
};

// What a frame is told of them. Mapped.
struct InstancesTold {
  std::vector<MotionSlots> meshes;     // one of each that deforms
  Slot<InstanceTransform> transforms;  // moved_count
  Slot<uint> turn;                     // of a swarm
};

// What a frame leaves. Mapped.
struct InstancesLeft {
  Slot<BuildState> mesh_states;  // of all meshes; none where none deforms
  Slot<RefitState> mesh_refits;
};

// `refits`: whether frames may be refitted; `keeps_sorted`: so that what the sort of instances leaves is not
// used for that. Throws what plan_vertices and plan_refit throw.
MovingInstances plan_moving_instances(Layout& layout, const Scene& scene, InstancePlan& plan, bool refits,
                                      std::uint32_t max_turns, bool keeps_sorted = false);
InstancesTold plan_instances_told(Layout& layout, const Scene& scene, const MovingInstances& moving);
InstancesLeft plan_instances_left(Layout& layout, const InstancePlan& plan, const MovingInstances& moving);

// Before the first frame: trees of what stands still. Meshes that deform have none yet.
std::vector<std::uint32_t> meshes_that_stand_still(const Scene& scene);

// Vertices and transforms to where they are.
void append_instance_places(Chain& chain, const Scene& scene, const InstancePlan& plan,
                            const MovingInstances& moving, const InstancesTold& told);

// Then the trees of meshes that deform and the tree over the instances, built or refitted; and its parts, of
// which one that is built has the order of refits with it or not.
void append_instance_trees(Chain& chain, const InstancePlan& plan, const MovingInstances& moving,
                           bool rebuilds);
void append_mesh_tree(Chain& chain, const InstancePlan& plan, const MovingInstances::Mesh& mesh,
                      bool rebuilds, bool with_order);
void append_top_tree(Chain& chain, const InstancePlan& plan, const MovingInstances& moving, bool rebuilds);

// And what the host reads of them.
void append_instances_left(Chain& chain, const InstancePlan& plan, const MovingInstances& moving,
                           const InstancesLeft& left);

// The transforms of moved_count instances at a time.
std::vector<InstanceTransform> transforms_told(const Scene& scene, const MovingInstances& moving,
                                               double seconds);

// The corners of a mesh's triangles, from its first vertex on.
std::vector<uvec3> indices_of(const Scene& scene, const InstancedMesh& mesh);

// What no frame changes, beside upload_frame.
template <class Executor>
void upload_moving_instances(Executor& executor, const MovingInstances& moving, const Scene& scene,
                             const SceneArrays& arrays) {
  if (moving.seed) executor.upload(moving.rest, std::span<const InstanceTransform>(arrays.transforms));
  for (const MovingInstances::Mesh& moved : moving.meshes) {
    const InstancedMesh& mesh = scene.meshes[moved.mesh];
    const std::vector<uvec3> indices = indices_of(scene, mesh);
    upload_vertices(executor, moved.vertices, *mesh.motion, std::span<const uvec3>(indices));
  }
}

template <class Executor>
void tell_instances(Executor& executor, const InstancesTold& told, const Scene& scene,
                    const MovingInstances& moving, double seconds) {
  for (std::size_t i = 0; i < moving.meshes.size(); ++i) {
    const Motion& motion = *scene.meshes[moving.meshes[i].mesh].motion;
    upload_step(executor, told.meshes[i], motion_step(motion, pose_at(motion, seconds), seconds));
  }
  if (moving.moved_count > 0) {
    const std::vector<InstanceTransform> transforms = transforms_told(scene, moving, seconds);
    executor.upload(told.transforms, std::span<const InstanceTransform>(transforms));
  }
  if (!moving.seed) return;
  const uint turn = turn_at(*scene.swarm, seconds);
  executor.upload(told.turn, std::span<const uint>(&turn, 1));
}

}  // namespace coppice
