#include "pipeline/bounded_submits.h"
#include "render/moving_tree.h"
#include "view/view_frames.h"

// What of a frame depends on whether its scene has one level or two, or a tree of the host.
namespace coppice {

// The keys of the sort are kept for what shows its order.
FramePlan ViewFrames::plan_instances_of(ViewFrames& frames, FrameOptions options) {
  options.trace.walk = Walk::binary;
  FramePlan plan = plan_frame(frames.layout_, frames.opened_.arrays, options);
  const Scene& scene = frames.opened_.scene;
  frames.instances_ =
      plan_moving_instances(frames.layout_, scene, plan.levels->plan,
                            frames.options_.update != Update::rebuild, options.trace.max_turns, true);
  frames.instances_at_ = plan_instances_told(frames.layout_, scene, frames.instances_);
  if (frames.instances_.top) frames.refit_ = frames.instances_.top->refit;
  return plan;
}

void ViewFrames::upload_scene() {
  upload_frame(executor_, plan_, opened_.arrays, Film{});
  if (plan_.levels) {
    upload_moving_instances(executor_, instances_, opened_.scene, opened_.arrays);
    Chain chain = executor_.chain();
    append_meshes(chain, plan_.levels->plan, meshes_that_stand_still(opened_.scene));
    if (!chain.steps().empty()) executor_.record(chain.steps()).submit_and_wait(piece_limit_seconds);
  } else if (plan_.build) {
    upload_vertices(executor_, vertices_, motion_, std::span<const uvec3>(opened_.scene.indices));
  } else {
    upload_bvh(executor_, plan_.tree, opened_.bvh);
  }
}

// The tree over instances is built where they stand still, too, as that is asked for.
void ViewFrames::append_update(Chain& chain, bool rebuilds) const {
  if (!plan_.levels) {
    append_vertices(chain, vertices_, at_, motion_);
    return append_moving_tree(chain, vertices_, plan_, refit_ ? &*refit_ : nullptr, rebuilds);
  }
  const InstancePlan& instances = plan_.levels->plan;
  if (!instances_.moves()) return append_top(chain, instances);
  append_instance_places(chain, opened_.scene, instances, instances_, instances_at_);
  append_instance_trees(chain, instances, instances_, rebuilds);
}

void ViewFrames::tell(double seconds) {
  if (plan_.levels) {
    tell_instances(executor_, instances_at_, opened_.scene, instances_, seconds);
  } else if (plan_.build) {
    upload_step(executor_, at_, motion_step(motion_, pose_at(motion_, seconds), seconds));
  }
}

// Primitives of all trees that a refit has no leaves for.
std::uint32_t ViewFrames::appeared() const {
  std::uint32_t count = executor_.read(refit_->state)[0].appeared_count;
  if (instances_.mesh_refits.count == 0) return count;
  for (const RefitState& state : executor_.read(instances_.mesh_refits)) count += state.appeared_count;
  return count;
}

}  // namespace coppice
