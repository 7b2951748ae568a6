#include "render/moving_instances.h"

#include "stages/stages.h"

namespace coppice {

namespace {

template <class T>
Slot<T> one_of(const Slot<T>& slot, std::uint64_t index) {
  return {{slot.place.block, slot.place.offset + index * sizeof(T)}, 1};
}

template <class T>
void append_copy(Chain& chain, const Slot<T>& from, Address<T> to) {
  static_assert(sizeof(T) % sizeof(uvec4) == 0);
  const auto quads = static_cast<uint>(from.bytes() / sizeof(uvec4));
  if (quads == 0) return;
  chain.run(stages::copy_words, {{chain.at(from).value}, {to.value}, quads, 0}, groups_of(quads, COPY_TILE));
}

}  // namespace

MovingInstances plan_moving_instances(Layout& layout, const Scene& scene, InstancePlan& plan, bool refits,
                                      std::uint32_t max_turns, bool keeps_sorted) {
  MovingInstances moving;
  for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
    const InstancedMesh& from = scene.meshes[mesh];
    if (!from.motion) continue;
    moving.meshes.push_back({mesh, plan_vertices(layout, *from.motion, from.triangle_count), {}});
  }
  if (scene.swarm) {
    moving.seed = scene.swarm->seed;
    moving.rest = layout.add<InstanceTransform>("rest", plan.instance_count, Memory::source);
  }
  if (scene.motion && !scene.motion->moved_instances.empty()) {
    const std::vector<std::uint32_t>& moved = scene.motion->moved_instances;
    moving.first_moved = moved.front();
    moving.moved_count = moved.back() + 1 - moved.front();
  }
  if (!refits || !moving.moves()) return moving;
  moving.top = plan_top_refit(layout, plan, max_turns, keeps_sorted);
  moving.mesh_refits = layout.add<RefitState>("mesh_refits", moving.meshes.size());
  for (std::size_t i = 0; i < moving.meshes.size(); ++i) {
    MovingInstances::Mesh& mesh = moving.meshes[i];
    mesh.refit = plan_mesh_refit(layout, plan, mesh.mesh, max_turns);
    mesh.refit.state = one_of(moving.mesh_refits, i);
  }
  return moving;
}

InstancesTold plan_instances_told(Layout& layout, const Scene& scene, const MovingInstances& moving) {
  InstancesTold told;
  for (const MovingInstances::Mesh& mesh : moving.meshes)
    told.meshes.push_back(plan_motion(layout, *scene.meshes[mesh.mesh].motion));
  told.transforms = layout.add_mapped<InstanceTransform>("transforms_told", moving.moved_count);
  told.turn = layout.add_mapped<uint>("turn_told", moving.seed ? 1 : 0);
  return told;
}

InstancesLeft plan_instances_left(Layout& layout, const InstancePlan& plan, const MovingInstances& moving) {
  const std::size_t states = moving.meshes.empty() ? 0 : plan.ranges.size();
  return {layout.add_mapped<BuildState>("mesh_states_left", states),
          layout.add_mapped<RefitState>("mesh_refits_left", moving.mesh_refits.count)};
}

std::vector<std::uint32_t> meshes_that_stand_still(const Scene& scene) {
  std::vector<std::uint32_t> still;
  for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
    if (!scene.meshes[mesh].motion) still.push_back(mesh);
  }
  return still;
}

void append_instance_places(Chain& chain, const Scene& scene, const InstancePlan& plan,
                            const MovingInstances& moving, const InstancesTold& told) {
  for (std::size_t i = 0; i < moving.meshes.size(); ++i) {
    const MovingInstances::Mesh& mesh = moving.meshes[i];
    append_vertices(chain, mesh.vertices, told.meshes[i], *scene.meshes[mesh.mesh].motion);
  }
  if (moving.moved_count > 0)
    append_copy(chain, told.transforms, chain.at(plan.transforms, moving.first_moved));
  if (moving.seed) append_moves(chain, plan, {moving.rest, told.turn}, *moving.seed);
}

void append_mesh_tree(Chain& chain, const InstancePlan& plan, const MovingInstances::Mesh& mesh,
                      bool rebuilds, bool with_order) {
  const BuildPlan build = mesh_plan(plan, mesh.mesh);
  const VertexTriangles triangles = triangles_of(chain, mesh.vertices);
  if (rebuilds) {
    append_build(chain, build, {triangles, {}});
    if (with_order) append_refit_order(chain, build, mesh.refit);
  } else {
    append_triangles(chain, build.triangles, triangles);
    append_refit(chain, build, mesh.refit);
  }
}

void append_top_tree(Chain& chain, const InstancePlan& plan, const MovingInstances& moving, bool rebuilds) {
  if (rebuilds) {
    append_top(chain, plan, moving.top ? &*moving.top : nullptr);
  } else {
    append_top_refit(chain, plan, *moving.top);
  }
}

void append_instance_trees(Chain& chain, const InstancePlan& plan, const MovingInstances& moving,
                           bool rebuilds) {
  if (!moving.moves()) return;
  for (const MovingInstances::Mesh& mesh : moving.meshes)
    append_mesh_tree(chain, plan, mesh, rebuilds, moving.top.has_value());
  append_top_tree(chain, plan, moving, rebuilds);
}

void append_instances_left(Chain& chain, const InstancePlan& plan, const MovingInstances& moving,
                           const InstancesLeft& left) {
  if (left.mesh_states.count > 0) append_copy(chain, plan.mesh_states, chain.at(left.mesh_states));
  if (left.mesh_refits.count > 0) append_copy(chain, moving.mesh_refits, chain.at(left.mesh_refits));
}

std::vector<InstanceTransform> transforms_told(const Scene& scene, const MovingInstances& moving,
                                               double seconds) {
  std::vector<InstanceTransform> told;
  told.reserve(moving.moved_count);
  for (std::uint32_t i = 0; i < moving.moved_count; ++i)
    told.push_back(rows_of(scene.instances[moving.first_moved + i].transform));
  const std::vector<glm::mat4x3> moved = instances_at(*scene.motion, seconds);
  for (std::size_t i = 0; i < moved.size(); ++i)
    told[scene.motion->moved_instances[i] - moving.first_moved] = rows_of(moved[i]);
  return told;
}

std::vector<uvec3> indices_of(const Scene& scene, const InstancedMesh& mesh) {
  std::vector<uvec3> indices;
  indices.reserve(mesh.triangle_count);
  for (std::uint32_t i = 0; i < mesh.triangle_count; ++i)
    indices.push_back(scene.indices[mesh.first_triangle + i] - mesh.first_vertex);
  return indices;
}

}  // namespace coppice
