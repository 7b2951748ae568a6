#include "render/moving_frames.h"

#include <stdexcept>

#include "pipeline/bounded_submits.h"
#include "render/moving_tree.h"
#include "scene/instances.h"
#include "stages/errors.h"
#include "stages/stages.h"

namespace coppice {

namespace {

// Words that the host reads when the frame is done, however the device keeps them.
template <class T>
void append_copy_out(Chain& chain, const Slot<T>& from, const Slot<T>& to) {
  static_assert(sizeof(T) % sizeof(uvec4) == 0);
  chain.run(stages::copy_words, {{chain.at(from).value}, {chain.at(to).value}, sizeof(T) / sizeof(uvec4), 0},
            {1, 1, 1});
}

void check_meshes(std::span<const BuildState> states) {
  for (const BuildState& state : states) {
    const std::string errors = describe_error_word(state.error_word);
    if (!errors.empty()) throw DeviceError("the tree of a mesh: " + errors);
  }
}

MovingOptions for_scene(MovingOptions options, const Scene& scene) {
  options.trace.directional_light = scene.light.radiance != vec3(0);
  return options;
}

}  // namespace

FramePlan MovingFrames::plan_all(MovingFrames& frames, const SceneArrays& arrays) {
  Layout& layout = frames.layout_;
  if (arrays.mesh_index.empty())
    frames.vertices_ = plan_vertices(layout, frames.motion_, arrays.triangle_count());
  const FrameOptions options{.build = frames.options_.build, .trace = frames.options_.trace};
  FramePlan plan = plan_frame(layout, arrays, options);
  const std::uint32_t max_turns = frames.options_.trace.max_turns;
  MovingInstances& moving = frames.instances_;
  if (plan.levels) {
    moving = plan_moving_instances(layout, frames.scene_, plan.levels->plan, frames.may_refit(), max_turns);
    if (!moving.moves()) frames.options_.update = Update::rebuild;
  }
  if (moving.top) {
    frames.refit_ = moving.top->refit;
  } else if (frames.has_state()) {
    frames.refit_ = plan_refit(layout, plan.tree, &*plan.build, max_turns);
  }
  for (std::uint32_t i = 0; i < frames.options_.under_way; ++i) {
    frames.slots_.push_back(
        {{plan.levels ? MotionSlots{} : plan_motion(layout, frames.motion_),
          plan_instances_told(layout, frames.scene_, moving), layout.add_mapped<Film>("film_told", 1)},
         {layout.add_mapped<uint>("image_left", plan.trace.image.count),
          layout.add_mapped<BuildState>("state_left", 1),
          layout.add_mapped<TraceCounters>("counters_left", 1),
          layout.add_mapped<TraceCounters>("shadow_counters_left", shadow_counters(plan.trace).count),
          layout.add_mapped<TraceCounters>("occlusion_counters_left",
                                           plan.trace.lights.occlusion_counters.count),
          layout.add_mapped<TraceCounters>("bounce_counters_left", plan.trace.paths.bounce_counters.count),
          layout.add_mapped<PathCounters>("lobe_counters_left", plan.trace.paths.lobe_counters.count),
          layout.add_mapped<RefitState>("refit_left", 1),
          plan.levels ? plan_instances_left(layout, plan.levels->plan, moving) : InstancesLeft{}}});
  }
  return plan;
}

MovingFrames::MovingFrames(Device& device, const Scene& scene, const MovingOptions& options)
    : MovingFrames(device, scene, scene_arrays(scene, effects_of(scene, options.effects)), options) {}

MovingFrames::MovingFrames(Device& device, const Scene& scene, const SceneArrays& arrays,
                           const MovingOptions& options)
    : scene_(scene),
      motion_(motion_of(scene)),
      options_(for_scene(options, scene)),
      layout_(device.properties().max_block_bytes),
      plan_(plan_all(*this, arrays)),
      executor_(device, layout_),
      measures_(device.properties().timestamp_period_ns > 0),
      chooser_(chooser()) {
  if (options_.under_way == 0) throw std::invalid_argument("no frame may be under way");
  upload_scene(arrays);
  build_what_stands_still();
  const auto record = [&](const FrameSlots& slots, bool rebuilds) {
    Chain chain = executor_.chain();
    append(chain, slots, rebuilds);
    return executor_.record(chain.steps());
  };
  for (const FrameSlots& slots : slots_) {
    builds_.push_back(record(slots, true));
    if (may_refit()) refits_.push_back(record(slots, false));
  }
}

void MovingFrames::upload_scene(const SceneArrays& arrays) {
  upload_frame(executor_, plan_, arrays, Film{});
  upload_moving_instances(executor_, instances_, scene_, arrays);
  if (!plan_.levels) upload_vertices(executor_, vertices_, motion_, std::span<const uvec3>(scene_.indices));
}

// Each in a submit of its own, as nobody waits for a frame yet. Where nothing moves, the tree over the
// instances too.
void MovingFrames::build_what_stands_still() {
  if (!plan_.levels) return;
  const InstancePlan& instances = plan_.levels->plan;
  const auto submit = [&](const auto& append) {
    Chain chain = executor_.chain();
    append(chain);
    executor_.record(chain.steps()).submit_and_wait(piece_limit_seconds);
  };
  for (const std::uint32_t mesh : meshes_that_stand_still(scene_))
    submit([&](Chain& chain) { append_meshes(chain, instances, {&mesh, 1}); });
  check_meshes(executor_.read(instances.mesh_states));
  if (!instances_.moves()) submit([&](Chain& chain) { append_top(chain, instances); });
}

// The device has to be done with what it is given.
MovingFrames::~MovingFrames() {
  for (const Waiting& waiting : waiting_) {
    try {
      (waiting.rebuilds ? builds_ : refits_)[waiting.slot].wait(piece_limit_seconds);
    } catch (const DeviceError&) {
      // Whoever asked for the frames has been told, or does not want to know.
    }
  }
}

void MovingFrames::append_places(Chain& chain, const Told& told) const {
  if (!plan_.levels) return append_vertices(chain, vertices_, told.motion, motion_);
  append_instance_places(chain, scene_, plan_.levels->plan, instances_, told.instances);
}

void MovingFrames::append_tree(Chain& chain, bool rebuilds) const {
  if (plan_.levels) {
    append_instance_trees(chain, plan_.levels->plan, instances_, rebuilds);
  } else {
    append_moving_tree(chain, vertices_, plan_, may_refit() ? &refit_ : nullptr, rebuilds);
  }
}

void MovingFrames::append_update(Chain& chain, bool rebuilds) const {
  append_tree(chain, rebuilds);
  chain.mark();
  append_moving_wide(chain, plan_, rebuilds);
  if (options_.tree_cost) append_tree_cost(chain, plan_.tree, refit_);
  chain.mark();
}

void MovingFrames::append(Chain& chain, const FrameSlots& slots, bool rebuilds) const {
  append_places(chain, slots.told);
  chain.mark();
  append_update(chain, rebuilds);
  append_picture(chain, slots);
}

void MovingFrames::append_picture(Chain& chain, const FrameSlots& slots) const {
  TracePlan trace = plan_.trace;
  trace.film = slots.told.film;
  trace.image = slots.left.image;
  TracePieces pieces = plan_.pieces(trace);
  while (!pieces.done()) pieces.append(chain, ~std::uint64_t{0});
  append_copy_out(chain, plan_.tree.state, slots.left.state);
  append_copy_out(chain, trace.counters, slots.left.counters);
  if (slots.left.shadow.count > 0) append_copy_out(chain, shadow_counters(trace), slots.left.shadow);
  if (slots.left.occlusion.count > 0)
    append_copy_out(chain, trace.lights.occlusion_counters, slots.left.occlusion);
  if (slots.left.bounced.count > 0) {
    append_copy_out(chain, trace.paths.bounce_counters, slots.left.bounced);
    append_copy_out(chain, trace.paths.lobe_counters, slots.left.lobes);
  }
  if (has_state()) append_copy_out(chain, refit_.state, slots.left.refit);
  if (plan_.levels) append_instances_left(chain, plan_.levels->plan, instances_, slots.left.instances);
}

std::vector<Step> MovingFrames::steps(bool rebuilds) const {
  Chain chain = executor_.chain();
  append(chain, last_slots(), rebuilds);
  return std::move(chain.steps());
}

std::vector<MovingFrames::Part> MovingFrames::parts() const {
  if (instances_.meshes.empty()) return {{steps(), *plan_.build}};
  const InstancePlan& plan = plan_.levels->plan;
  std::vector<Part> parts;
  Chain chain = executor_.chain();
  append_places(chain, last_slots().told);
  for (const MovingInstances::Mesh& mesh : instances_.meshes) {
    append_mesh_tree(chain, plan, mesh, true, may_refit());
    parts.push_back({std::move(chain.steps()), mesh_plan(plan, mesh.mesh)});
    chain = executor_.chain();
  }
  append_top_tree(chain, plan, instances_, true);
  if (options_.tree_cost) append_tree_cost(chain, plan_.tree, refit_);
  append_picture(chain, last_slots());
  parts.push_back({std::move(chain.steps()), *plan_.build});
  return parts;
}

void MovingFrames::tell(const Told& told, double seconds, const Film& film) {
  executor_.upload(told.film, std::span<const Film>(&film, 1));
  tell_instances(executor_, told.instances, scene_, instances_, seconds);
  if (!plan_.levels)
    upload_step(executor_, told.motion, motion_step(motion_, pose_at(motion_, seconds), seconds));
}

UpdateChooser MovingFrames::chooser() const {
  const bool blind = options_.update == Update::automatic && !measures_;
  return UpdateChooser(blind ? Update::rebuild : options_.update);
}

void MovingFrames::submit(double seconds, const Film& film) {
  if (!has_room()) throw std::logic_error("as many frames as there may be are under way");
  tell(slots_[next_slot_].told, seconds, film);
  const bool rebuilds = !chooser_.next_refits();
  (rebuilds ? builds_ : refits_)[next_slot_].submit();
  waiting_.push_back({next_slot_, seconds, rebuilds});
  next_slot_ = (next_slot_ + 1) % slots_.size();
}

// Of the trees of the frame, all together.
std::uint32_t MovingFrames::appeared(const Left& left) {
  const Slot<RefitState>& meshes = left.instances.mesh_refits;
  std::uint32_t count = mapped(left.refit)->appeared_count;
  for (std::uint64_t i = 0; i < meshes.count; ++i) count += mapped(meshes)[i].appeared_count;
  return count;
}

template <class T>
const T* MovingFrames::mapped(const Slot<T>& slot) {
  return reinterpret_cast<const T*>(executor_.arena().mapped(slot.place.block) + slot.place.offset);
}

MovingFrame MovingFrames::outcome(const Recorder::Times& times, const Left& left) {
  MovingFrame frame;
  frame.total_ms = times.total_ms;
  frame.wall_ms = times.wall_ms;
  if (!times.marks_ms.empty()) {
    frame.vertices_ms = times.marks_ms[0];
    frame.update_ms = times.marks_ms[1] - times.marks_ms[0];
    frame.wide_ms = times.marks_ms[2] - times.marks_ms[1];
    frame.trace_ms = times.total_ms - times.marks_ms[2];
  }
  frame.state = *mapped(left.state);
  frame.counts = counts_of(*mapped(left.counters));
  if (left.shadow.count > 0) frame.shadow = counts_of(*mapped(left.shadow));
  if (left.occlusion.count > 0) frame.occlusion = counts_of(*mapped(left.occlusion));
  if (left.bounced.count > 0) frame.bounced = counts_of(*mapped(left.bounced));
  if (left.lobes.count > 0) frame.lobes = counts_of(*mapped(left.lobes));
  frame.image = {mapped(left.image), left.image.count};
  if (options_.tree_cost) frame.sah = sah_cost(*mapped(left.refit), frame.state.active_count);
  return frame;
}

MovingFrame MovingFrames::take() {
  if (waiting_.empty()) throw std::logic_error("no frame is under way");
  Waiting waiting = waiting_.front();
  waiting_.pop_front();
  const Left& left = slots_[waiting.slot].left;
  const auto wait = [&] {
    const Recorder::Times times =
        (waiting.rebuilds ? builds_ : refits_)[waiting.slot].wait(piece_limit_seconds);
    return outcome(times, left);
  };
  MovingFrame frame = wait();
  if (!waiting.rebuilds && appeared(left) > 0) {
    waiting.rebuilds = true;
    builds_[waiting.slot].submit();
    const double first_wall_ms = frame.wall_ms;
    frame = wait();
    frame.wall_ms += first_wall_ms;
    frame.submits = 2;
  }
  frame.kept = plan_.levels && !instances_.moves();
  frame.rebuilt = waiting.rebuilds && !frame.kept;
  frame.seconds = waiting.seconds;
  const std::string errors = describe_error_word(frame.state.error_word);
  if (!errors.empty())
    throw DeviceError("the frame at second " + std::to_string(frame.seconds) + ": " + errors);
  const Slot<BuildState>& meshes = left.instances.mesh_states;
  if (meshes.count > 0) check_meshes({mapped(meshes), meshes.count});
  chooser_.note({frame.rebuilt, frame.submits > 1, frame.update_ms + frame.wide_ms, frame.trace_ms,
                 frame.counts.steps + frame.shadow.steps + frame.occlusion.steps + frame.bounced.steps});
  return frame;
}

}  // namespace coppice
