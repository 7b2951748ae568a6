#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat4x3.hpp>
#include <span>
#include <vector>

#include "interface/gather.h"
#include "pipeline/instances.h"
#include "scene/random.h"
#include "stages/stages.h"

namespace coppice {

struct InstancesToTrace {
  std::vector<std::vector<Triangle>> meshes;
  std::vector<uint> mesh_index;  // one an instance
  std::vector<InstanceTransform> transforms;
};

// All triangles of all instances in the world, instance after instance, by the twin of gather_triangles.
inline std::vector<Triangle> flattened(const InstancesToTrace& scene) {
  std::vector<Triangle> all;
  for (std::size_t i = 0; i < scene.mesh_index.size(); ++i) {
    if (scene.mesh_index[i] >= scene.meshes.size()) continue;
    const std::vector<Triangle>& mesh = scene.meshes[scene.mesh_index[i]];
    std::vector<Triangle> moved(mesh.size());
    GatherTrianglesArgs args{};
    args.vertices.value = reinterpret_cast<std::uint64_t>(mesh.data());
    args.transform.value = reinterpret_cast<std::uint64_t>(&scene.transforms[i]);
    args.triangles.value = reinterpret_cast<std::uint64_t>(moved.data());
    args.triangle_count = static_cast<uint>(mesh.size());
    args.vertex_count = 3 * args.triangle_count;
    args.vertex_stride = sizeof(vec3);
    twins::gather_triangles(args);
    all.insert(all.end(), moved.begin(), moved.end());
  }
  return all;
}

// Hits of instances as hits of the flattened scene.
inline std::vector<Hit> flattened_hits(const InstancesToTrace& scene, std::span<const Hit> hits,
                                       std::span<const uint> hit_instances) {
  std::vector<uint> first;
  uint count = 0;
  for (const uint mesh : scene.mesh_index) {
    first.push_back(count);
    if (mesh < scene.meshes.size()) count += static_cast<uint>(scene.meshes[mesh].size());
  }
  std::vector<Hit> flat(hits.begin(), hits.end());
  for (std::size_t i = 0; i < flat.size(); ++i) {
    if (flat[i].triangle != NO_TRIANGLE) flat[i].triangle += first[hit_instances[i]];
  }
  return flat;
}

inline InstanceTransform transform_of(const vec3& x, const vec3& y, const vec3& z, const vec3& move) {
  return {{x.x, y.x, z.x}, move.x, {x.y, y.y, z.y}, move.y, {x.z, y.z, z.z}, move.z};
}

// As a scene has it.
inline glm::mat4x3 columns_of(const InstanceTransform& t) {
  return {t.row_x.x, t.row_y.x, t.row_z.x, t.row_x.y, t.row_y.y, t.row_z.y,
          t.row_x.z, t.row_y.z, t.row_z.z, t.move_x,  t.move_y,  t.move_z};
}

inline InstanceTransform moved_by(const vec3& move) {
  return transform_of({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, move);
}

// Whatever matrix, its columns of lengths between 2^-exponent and 2^exponent.
inline InstanceTransform random_transform(Random& random, float exponent, float spread) {
  vec3 columns[3];
  for (vec3& column : columns) {
    const vec3 direction = random.direction();
    column = direction * std::exp2(exponent * (2 * random.uniform() - 1));
  }
  return transform_of(columns[0], columns[1], columns[2], spread * random.in_cube());
}

struct InstanceSlots {
  InstancePlan plan;
  RaySlots rays;
  Slot<uint> hit_instances;
  SwarmSlots swarm;  // for those who move them
};

inline InstanceSlots plan_for(Layout& layout, const InstancesToTrace& scene, std::size_t ray_count,
                              const BuildOptions& options = {}) {
  std::vector<std::uint32_t> counts;
  for (const auto& mesh : scene.meshes) counts.push_back(static_cast<std::uint32_t>(mesh.size()));
  InstanceSlots slots;
  slots.plan = plan_instances(layout, counts, static_cast<std::uint32_t>(scene.mesh_index.size()), options);
  slots.rays = {layout.add<Ray>("rays", ray_count),
                layout.add<Hit>("hits", ray_count),
                layout.add<TraceCounters>("counters", 1),
                {}};
  slots.hit_instances = layout.add<uint>("hit_instances", ray_count);
  slots.swarm = {layout.add<InstanceTransform>("rest", slots.plan.instance_count),
                 layout.add<uint>("turn", 1)};
  return slots;
}

template <class Executor>
void upload_instances(Executor& executor, const InstanceSlots& slots, const InstancesToTrace& scene,
                      std::span<const Ray> rays) {
  std::vector<Hit> misses;
  for (const Ray& ray : rays) misses.push_back({ray.t_max, NO_TRIANGLE, 0, 0});
  executor.upload(slots.plan.meshes, std::span<const MeshRange>(slots.plan.ranges));
  for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
    executor.upload(triangles_of(slots.plan, mesh), std::span<const Triangle>(scene.meshes[mesh]));
  executor.upload(slots.plan.mesh_index, std::span<const uint>(scene.mesh_index));
  executor.upload(slots.plan.transforms, std::span<const InstanceTransform>(scene.transforms));
  constexpr uint turn = 12345;
  executor.upload(slots.swarm.rest, std::span<const InstanceTransform>(scene.transforms));
  executor.upload(slots.swarm.turn, std::span<const uint>(&turn, 1));
  executor.upload(slots.rays.rays, rays);
  executor.upload(slots.rays.hits, std::span<const Hit>(misses));
}

inline void append_all(Chain& chain, const InstanceSlots& slots, const TraceOptions& options) {
  append_all_meshes(chain, slots.plan);
  append_top(chain, slots.plan);
  append_instance_hits(chain, slots.plan, slots.rays, slots.hit_instances,
                       static_cast<std::uint32_t>(slots.rays.rays.count), options);
}

}  // namespace coppice
