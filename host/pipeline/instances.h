#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interface/instances.h"
#include "pipeline/build_plan.h"
#include "pipeline/refit.h"
#include "pipeline/trace_plan.h"

namespace coppice {

// Two levels: meshes, each with a tree of its own, and a tree whose leaves are instances of them. Both are
// built on the device, one behind the other in as few submits as the caller likes; the host knows neither
// transforms nor boxes. Instances are of meshes, not of instances.
struct InstancePlan {
  BuildOptions options;
  std::vector<MeshRange> ranges;  // of each mesh: what `meshes` holds
  std::uint32_t instance_count = 0;

  // Of all meshes, one behind the other.
  Slot<MeshRange> meshes;         // in
  Slot<Triangle> mesh_triangles;  // in: in the space of the mesh; denormals and -0 as +0
  Slot<Node> mesh_nodes;
  Slot<BuildState> mesh_states;  // one a mesh

  Slot<InstanceTransform> transforms;  // in, or by append_moves
  Slot<uint> mesh_index;               // in: one an instance
  Slot<PlacedInstance> placed;
  Slot<Aabb> instance_boxes;
  Slot<Triangle> corners;  // that have these boxes; none unless the tree over the instances is refitted
  Slot<uint> mesh_height;

  BuildPlan scratch;  // of the largest build, one after the other
  BuildPlan top;      // over the instances; its nodes and state are out
};

// For meshes of so many triangles each. Throws LayoutError if a slot does not fit a block, and
// std::invalid_argument for options out of range or more triangles or instances than a build takes.
InstancePlan plan_instances(Layout& layout, std::span<const std::uint32_t> mesh_triangles,
                            std::uint32_t instance_count, const BuildOptions& options);

// Where the triangles of a mesh lie.
Slot<Triangle> triangles_of(const InstancePlan& plan, std::uint32_t mesh);

// The build of one mesh, in its part of the slots of all.
BuildPlan mesh_plan(const InstancePlan& plan, std::uint32_t mesh);

// What refits of the tree over the instances need, planned behind all else: it goes by triangles that have
// the instances' boxes. `keeps_sorted`: what the sort of a build leaves is not used for them. Throws
// LayoutError.
struct TopRefit {
  TreeSlots tree;  // over those triangles
  RefitPlan refit;
};
TopRefit plan_top_refit(Layout& layout, InstancePlan& plan, std::uint32_t max_turns,
                        bool keeps_sorted = false);

// The same of a mesh's tree; it keeps its order while other meshes are built.
RefitPlan plan_mesh_refit(Layout& layout, const InstancePlan& plan, std::uint32_t mesh,
                          std::uint32_t max_turns);

// The trees of these meshes; those of others stay as they are. So where meshes deform, only those that did
// are built again, and append_top follows.
void append_meshes(Chain& chain, const InstancePlan& plan, std::span<const std::uint32_t> meshes);
void append_all_meshes(Chain& chain, const InstancePlan& plan);

// What transforms that move come from (stage move_instances).
struct SwarmSlots {
  Slot<InstanceTransform> rest;  // in: one an instance
  Slot<uint> turn;               // in: one, in parts of a cycle of 2^32
};
void append_moves(Chain& chain, const InstancePlan& plan, const SwarmSlots& from, std::uint32_t seed);

// From transforms, and the trees of the meshes, to the tree over the instances. `refit`: with the order of
// its refits, if it will be refitted.
void append_top(Chain& chain, const InstancePlan& plan, const TopRefit* refit = nullptr);

// The same with the tree of the last append_top, refitted. An instance that was inactive then and is active
// now is in no leaf, see append_refit.
void append_top_refit(Chain& chain, const InstancePlan& plan, const TopRefit& refit);

// The closest hits of the first `ray_count` rays, improved in place, with their instances. Of the options
// max_turns and stack_entries matter: the stack takes the heights of both levels. Throws
// std::invalid_argument for any but the watertight and the robust test, and for a filter.
void append_instance_hits(Chain& chain, const InstancePlan& plan, const RaySlots& slots,
                          const Slot<uint>& hit_instances, std::uint32_t ray_count,
                          const TraceOptions& options, std::uint32_t first_ray = 0);

// What is shaded of hits of instances by stages of one level: a triangle and a material a ray.
struct PlacedHitSlots {
  Slot<uint> mesh_materials;  // in: one a triangle of InstancePlan::mesh_triangles
  Slot<uint> hit_instances;
  Slot<Triangle> triangles;
  Slot<uint> material_index;
  Slot<uint> primitives;  // the triangle in its mesh; none unless `names_primitives`
};
PlacedHitSlots plan_placed_hits(Layout& layout, const InstancePlan& plan, std::uint32_t ray_count,
                                bool names_primitives = false);

// Of the hits of rays that follow each other; see PlaceHitsArgs.
void append_placed_hits(Chain& chain, const InstancePlan& plan, const RaySlots& slots,
                        const PlacedHitSlots& placed, std::uint32_t first_ray, std::uint32_t ray_count);

// The closest hits of the first rays of their slots, cut as HitPieces are.
class InstanceHitPieces {
 public:
  InstanceHitPieces(const InstancePlan& plan, const RaySlots& slots, const Slot<uint>& hit_instances,
                    std::uint32_t ray_count, const TraceOptions& options)
      : plan_(&plan),
        slots_(slots),
        hit_instances_(hit_instances),
        options_(options),
        ray_count_(ray_count) {}

  bool done() const { return first_ == ray_count_; }

  // As HitPieces::append.
  std::uint64_t append(Chain& chain, std::uint64_t work);

 private:
  const InstancePlan* plan_;  // outlives it
  RaySlots slots_;
  Slot<uint> hit_instances_;
  TraceOptions options_;
  std::uint32_t ray_count_, first_ = 0;
};

}  // namespace coppice
