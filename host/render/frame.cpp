#include "render/frame.h"

#include <string>

#include "gpu/device.h"

namespace coppice {

FramePlan plan_frame(Layout& layout, const SceneArrays& scene, const FrameOptions& options) {
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
  if (plan.build) append_build(chain, *plan.build);
}

void append_frame_wide(Chain& chain, const FramePlan& plan) {
  if (plan.wide) append_wide(chain, plan.tree, *plan.wide);
}

void append_frame(Chain& chain, const FramePlan& plan) {
  append_frame_build(chain, plan);
  append_frame_wide(chain, plan);
  append_trace(chain, plan.tree, plan.trace);
}

void check_height(const Bvh& bvh) {
  if (!bvh.nodes.empty() && bvh.nodes[0].height > TRACE_STACK_LIMIT)
    throw DeviceError("the tree is " + std::to_string(bvh.nodes[0].height) +
                      " levels deep, the device's tracer takes " + std::to_string(TRACE_STACK_LIMIT));
}

}  // namespace coppice
