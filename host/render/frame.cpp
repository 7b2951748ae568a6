#include "render/frame.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace coppice {

namespace {

FramePlan plan_instanced_frame(Layout& layout, const SceneArrays& scene, const FrameOptions& options) {
  if (options.trace.lights.shadows > 0)
    throw std::invalid_argument("shadows are traced through trees of one level");
  if (options.trace.lights.occlusion)
    throw std::invalid_argument("occlusion is traced through trees of one level");
  if (options.trace.textures.textures > 0)
    throw std::invalid_argument("textures lie on triangles of one level");
  if (options.trace.alpha.maps > 0) throw std::invalid_argument("triangles of one level let rays through");
  if (!options.build || options.trace.walk != Walk::binary)
    throw std::invalid_argument("instances are built on the device and walked through binary trees");
  std::vector<std::uint32_t> counts;
  for (const InstancedMesh& mesh : scene.meshes) counts.push_back(mesh.triangle_count);
  FramePlan plan;
  plan.levels.emplace();
  InstancePlan& instances = plan.levels->plan;
  instances =
      plan_instances(layout, counts, static_cast<std::uint32_t>(scene.mesh_index.size()), *options.build);
  plan.build = instances.top;
  plan.tree = instances.top;
  TreeSlots no_triangles = plan.tree;
  no_triangles.triangle_count = 0;  // each ray has a material of its own
  plan.trace =
      plan_trace(layout, no_triangles, static_cast<std::uint32_t>(scene.materials.size()), options.trace);
  const uint show = options.trace.show;
  plan.levels->hits = plan_placed_hits(layout, instances, plan.trace.band_rays, show == SHOW_IDS);
  if (show == SHOW_RANKS || show == SHOW_GROUPS)
    plan.trace.show.primitive_values = layout.add<uint>("instance_values", instances.instance_count);
  return plan;
}

}  // namespace

FramePlan plan_frame(Layout& layout, const SceneArrays& scene, const FrameOptions& given) {
  FrameOptions options = given;
  const bool colours = options.trace.show == SHOW_COLOR;
  options.trace.lights = colours ? scene.light_counts : LightCounts{};
  options.trace.textures = colours ? scene.texture_counts() : TextureCounts{};
  options.trace.lens = colours && scene.lens;
  if ((options.trace.lights.shadows > 0 || options.trace.lights.occlusion) &&
      options.trace.walk == Walk::brute_force)
    throw std::invalid_argument("shadows and occlusion are traced through a tree");
  options.trace.paths = colours ? scene.paths.counts : PathCounts{};
  if (options.trace.paths.any() && options.trace.walk == Walk::brute_force)
    throw std::invalid_argument("paths are traced through a tree");
  options.trace.alpha = colours ? scene.alpha_counts() : AlphaCounts{};
  if (options.trace.alpha.maps > 0 && options.trace.walk == Walk::brute_force)
    throw std::invalid_argument("alpha is looked at by what walks through a tree");
  if (!scene.mesh_index.empty()) return plan_instanced_frame(layout, scene, options);
  FramePlan plan;
  if (options.build) plan.build = plan_build(layout, scene.triangle_count(), *options.build);
  if (!options.build) plan.tree = plan_tree(layout, scene.triangle_count(), options.node_count);
  TreeSlots& tree = plan.build ? *plan.build : plan.tree;
  if (is_wide(options.trace.walk))
    plan.wide = plan_wide(layout, tree, plan.build ? &*plan.build : nullptr, options.trace.max_turns);
  if (plan.build) plan.tree = *plan.build;
  plan.trace =
      plan_trace(layout, plan.tree, static_cast<std::uint32_t>(scene.materials.size()), options.trace);
  return plan;
}

void append_frame_build(Chain& chain, const FramePlan& plan) {
  if (plan.levels) {
    append_frame_meshes(chain, plan);
    append_top(chain, plan.levels->plan);
  } else if (plan.build) {
    append_build(chain, *plan.build);
  }
}

void append_frame_meshes(Chain& chain, const FramePlan& plan) {
  if (plan.levels) append_all_meshes(chain, plan.levels->plan);
}

void append_frame_wide(Chain& chain, const FramePlan& plan) {
  if (plan.wide) append_wide(chain, plan.tree, *plan.wide);
}

void append_frame(Chain& chain, const FramePlan& plan) {
  append_frame_build(chain, plan);
  append_frame_wide(chain, plan);
  TracePieces pieces = plan.pieces(plan.trace);
  while (!pieces.done()) pieces.append(chain, ~std::uint64_t{0});
}

void check_height(const Bvh& bvh) {
  if (!bvh.nodes.empty() && bvh.nodes[0].height > TRACE_STACK_LIMIT)
    throw DeviceError("the tree is " + std::to_string(bvh.nodes[0].height) +
                      " levels deep, the device's tracer takes " + std::to_string(TRACE_STACK_LIMIT));
}

}  // namespace coppice
