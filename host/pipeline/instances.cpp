#include "pipeline/instances.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include "stages/stages.h"

namespace coppice {

namespace {

std::uint64_t nodes_of(std::uint64_t leaves) { return leaves == 0 ? 0 : 2 * leaves - 1; }

// Triangles are read as words of 64 bits, from each mesh's first one on.
std::uint64_t even(std::uint64_t count) { return count + count % 2; }

template <class T>
Slot<T> part_of(const Slot<T>& slot, std::uint64_t first, std::uint64_t count) {
  return {{slot.place.block, slot.place.offset + first * sizeof(T)}, count};
}

void append_instance_boxes(Chain& chain, const InstancePlan& plan) {
  const Address<Triangle> none{};
  chain.clear(plan.mesh_height);
  chain.run(stages::instance_boxes,
            {chain.at(plan.transforms), chain.at(plan.mesh_index), chain.at(plan.meshes),
             chain.at(plan.mesh_states), chain.at(plan.mesh_nodes), chain.at(plan.placed),
             chain.at(plan.instance_boxes), plan.corners.count == 0 ? none : chain.at(plan.corners),
             chain.at(plan.mesh_height), plan.instance_count, static_cast<uint>(plan.ranges.size())},
            groups_of(plan.instance_count, INSTANCE_BOXES_GROUP));
}

}  // namespace

InstancePlan plan_instances(Layout& layout, std::span<const std::uint32_t> mesh_triangles,
                            std::uint32_t instance_count, const BuildOptions& options) {
  InstancePlan plan;
  plan.options = options;
  plan.instance_count = instance_count;
  std::uint64_t triangles = 0, nodes = 0;
  std::uint32_t most = instance_count;
  for (const std::uint32_t count : mesh_triangles) {
    check_build(count, options);
    if (nodes + nodes_of(count) > NO_INSTANCE)
      throw std::invalid_argument("meshes of more nodes in all than 32 bits count");
    plan.ranges.push_back({static_cast<uint>(nodes), static_cast<uint>(triangles), count, 0});
    triangles += even(count);
    nodes += nodes_of(count);
    most = std::max(most, count);
  }
  if (instance_count > 65535u * std::min(MOVE_INSTANCES_GROUP, INSTANCE_BOXES_GROUP))
    throw std::invalid_argument(std::to_string(instance_count) + " instances, more than a dispatch takes");
  plan.meshes = layout.add<MeshRange>("meshes", plan.ranges.size(), Memory::source);
  plan.mesh_triangles = layout.add<Triangle>("mesh_triangles", triangles, Memory::tree);
  plan.mesh_nodes = layout.add<Node>("mesh_nodes", nodes, Memory::tree);
  plan.mesh_states = layout.add<BuildState>("mesh_states", plan.ranges.size(), Memory::tree);
  plan.transforms = layout.add<InstanceTransform>("transforms", instance_count, Memory::source);
  plan.mesh_index = layout.add<uint>("mesh_index", instance_count, Memory::source);
  plan.placed = layout.add<PlacedInstance>("placed", instance_count, Memory::tree);
  plan.instance_boxes = layout.add<Aabb>("instance_boxes", instance_count);
  plan.mesh_height = layout.add<uint>("mesh_height", 1, Memory::tree);
  plan.scratch = plan_build(layout, most, options, PrimitiveKind::boxes);
  plan.top = with_count(plan.scratch, instance_count);
  return plan;
}

Slot<Triangle> triangles_of(const InstancePlan& plan, std::uint32_t mesh) {
  const MeshRange& range = plan.ranges.at(mesh);
  return part_of(plan.mesh_triangles, range.first_triangle, range.triangle_count);
}

BuildPlan mesh_plan(const InstancePlan& plan, std::uint32_t mesh) {
  const MeshRange& range = plan.ranges.at(mesh);
  BuildPlan build = with_count(plan.scratch, range.triangle_count);
  build.triangles = triangles_of(plan, mesh);
  build.nodes = part_of(plan.mesh_nodes, range.first_node, nodes_of(range.triangle_count));
  build.state = part_of(plan.mesh_states, mesh, 1);
  return build;
}

TopRefit plan_top_refit(Layout& layout, InstancePlan& plan, std::uint32_t max_turns, bool keeps_sorted) {
  plan.corners = layout.add<Triangle>("instance_corners", plan.instance_count, Memory::tree);
  TopRefit refit{plan.top, {}};
  refit.tree.triangles = plan.corners;
  refit.refit = plan_refit(layout, refit.tree, keeps_sorted ? nullptr : &plan.top, max_turns);
  return refit;
}

RefitPlan plan_mesh_refit(Layout& layout, const InstancePlan& plan, std::uint32_t mesh,
                          std::uint32_t max_turns) {
  const BuildPlan build = mesh_plan(plan, mesh);
  return plan_refit(layout, build, &build, max_turns, true);
}

void append_meshes(Chain& chain, const InstancePlan& plan, std::span<const std::uint32_t> meshes) {
  for (const std::uint32_t mesh : meshes) append_build(chain, mesh_plan(plan, mesh));
}

void append_all_meshes(Chain& chain, const InstancePlan& plan) {
  for (std::uint32_t mesh = 0; mesh < plan.ranges.size(); ++mesh) append_meshes(chain, plan, {&mesh, 1});
}

void append_moves(Chain& chain, const InstancePlan& plan, const SwarmSlots& from, std::uint32_t seed) {
  chain.run(stages::move_instances,
            {chain.at(from.rest), chain.at(from.turn), chain.at(plan.transforms), plan.instance_count, seed},
            groups_of(plan.instance_count, MOVE_INSTANCES_GROUP));
}

void append_top(Chain& chain, const InstancePlan& plan, const TopRefit* refit) {
  append_instance_boxes(chain, plan);
  append_build(chain, plan.top, {GivenBoxes{{chain.at(plan.instance_boxes).value}}, {}});
  if (refit) append_refit_order(chain, refit->tree, refit->refit);
}

void append_top_refit(Chain& chain, const InstancePlan& plan, const TopRefit& refit) {
  append_instance_boxes(chain, plan);
  append_refit(chain, refit.tree, refit.refit);
}

void append_instance_hits(Chain& chain, const InstancePlan& plan, const RaySlots& slots,
                          const Slot<uint>& hit_instances, std::uint32_t ray_count,
                          const TraceOptions& options, std::uint32_t first_ray) {
  if (options.triangle_test != TRIANGLE_WATERTIGHT || options.box_test != BOX_ROBUST)
    throw std::invalid_argument("instances are traced with the watertight and the robust test");
  if (slots.filter.masks() || slots.filter.count_at.count != 0)
    throw std::invalid_argument("instances are traced without masks and without a count on the device");
  chain.run(
      stages::trace_instances,
      {chain.at(plan.top.nodes), chain.at(plan.mesh_nodes), chain.at(plan.mesh_triangles),
       chain.at(plan.meshes), chain.at(plan.placed), chain.at(plan.transforms),
       chain.at(slots.rays, first_ray), chain.at(slots.hits, first_ray), chain.at(hit_instances, first_ray),
       chain.at(slots.counters), chain.at(plan.top.state), chain.at(plan.mesh_height),
       address_or_null(chain, slots.ray_steps, first_ray), ray_count, options.stack_entries},
      groups_of(ray_count, TRACE_GROUP),
      {options.max_turns, options.stack_entries, slots.ray_steps.count != 0});
}

PlacedHitSlots plan_placed_hits(Layout& layout, const InstancePlan& plan, std::uint32_t ray_count,
                                bool names_primitives) {
  return {layout.add<uint>("mesh_materials", plan.mesh_triangles.count, Memory::source),
          layout.add<uint>("hit_instances", ray_count), layout.add<Triangle>("hit_triangles", ray_count),
          layout.add<uint>("hit_materials", ray_count),
          layout.add<uint>("hit_primitives", names_primitives ? ray_count : 0)};
}

void append_placed_hits(Chain& chain, const InstancePlan& plan, const RaySlots& slots,
                        const PlacedHitSlots& placed, std::uint32_t first_ray, std::uint32_t ray_count) {
  chain.run(stages::place_hits,
            {chain.at(placed.hit_instances, first_ray), chain.at(plan.placed), chain.at(plan.transforms),
             chain.at(plan.meshes), chain.at(plan.mesh_triangles), chain.at(placed.mesh_materials),
             chain.at(slots.hits, first_ray), chain.at(placed.triangles, first_ray),
             chain.at(placed.material_index, first_ray), address_or_null(chain, placed.primitives, first_ray),
             ray_count, 0},
            groups_of(ray_count, SHADE_GROUP));
}

std::uint64_t InstanceHitPieces::append(Chain& chain, std::uint64_t work) {
  const std::uint64_t most = std::max<std::uint64_t>(work / RANGE_RAYS, 1) * RANGE_RAYS;
  const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, ray_count_ - first_));
  append_instance_hits(chain, *plan_, slots_, hit_instances_, count, options_, first_);
  first_ += count;
  return count;
}

}  // namespace coppice
