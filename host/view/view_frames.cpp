#include "view/view_frames.h"

#include <algorithm>
#include <utility>

#include "analysis/quality.h"
#include "measure/refine.h"
#include "measure/show_frame.h"
#include "pipeline/bounded_submits.h"
#include "render/moving_tree.h"
#include "stages/errors.h"

namespace coppice {

namespace {

// Kernels that a reader takes for one; else a kernel is a group of its own.
std::string group_of(std::string_view stage) {
  constexpr std::pair<std::string_view, const char*> prefixes[] = {
      {"vertex_", "vertices"},    {"gather_", "bounds"},
      {"primitive_", "bounds"},   {"sort_", "sort"},
      {"ploc_", "PLOC"},          {"hploc_", "H-PLOC"},
      {"wide_", "wide"},          {"trace_", "trace"},
      {"morton_", "Morton"},      {"refit_", "refit"},
      {"camera_", "camera"},      {"move_", "instances"},
      {"instance_", "instances"}, {"copy_", "instances"},
      {"place_", "instances"},    {"shadow_", "shadows"},
      {"scan_", "shadows"},       {"prefix_", "shadows"},
      {"shade_lights", "lights"}, {"texture_", "textures"},
      {"occlusion_", "ambient"},  {"shade_ambient", "ambient"},
      {"path_", "paths"},         {"noise_", "refine"},
      {"sample_", "refine"}};
  for (const auto& [prefix, name] : prefixes) {
    if (stage.starts_with(prefix)) return name;
  }
  return std::string(stage);
}

// Marks where another group begins; clears go with what follows them.
std::vector<std::string> mark_groups(std::vector<Step>& steps) {
  std::vector<std::string> groups;
  std::vector<Step> marked;
  std::vector<Step> clears;
  for (Step& step : steps) {
    const StageDeclaration* const stage = stage_of(step);
    if (!stage) {
      clears.push_back(std::move(step));
      continue;
    }
    const std::string group = group_of(stage->name);
    if (groups.empty() || groups.back() != group) {
      if (!groups.empty()) marked.push_back(Mark{});
      groups.push_back(group);
    }
    marked.insert(marked.end(), clears.begin(), clears.end());
    clears.clear();
    marked.push_back(std::move(step));
  }
  marked.insert(marked.end(), clears.begin(), clears.end());
  steps = std::move(marked);
  return groups;
}

}  // namespace

FramePlan ViewFrames::plan_all(ViewFrames& frames, CheckedDevice& device) {
  const OpenedScene& opened = frames.opened_;
  FrameOptions options{.trace =
                           device.picture_options(frames.options_.trace, opened.arrays.triangle_count())};
  options.trace.directional_light = opened.scene.light.radiance != vec3(0);
  options.trace.show = kernel_view(frames.options_.show.show);
  if (frames.options_.builder.on_device()) {
    options.build = device.build_options(frames.options_.builder.build_options(frames.morton_bits_));
    if (!opened.scene.instances.empty()) return plan_instances_of(frames, options);
    frames.vertices_ = plan_vertices(frames.layout_, frames.motion_, opened.arrays.triangle_count());
    frames.at_ = plan_motion(frames.layout_, frames.motion_);
  } else {
    options.node_count = opened.bvh.nodes.size();
    if (opened.builder.name == "none") options.trace.walk = Walk::brute_force;
  }
  FramePlan plan = plan_frame(frames.layout_, opened.arrays, options);
  if (frames.options_.update != Update::rebuild && plan.build && opened.scene.motion)
    frames.refit_ = plan_refit(frames.layout_, plan.tree, nullptr, options.trace.max_turns);
  return plan;
}

std::optional<TracePlan> ViewFrames::plan_passes(ViewFrames& frames) {
  const bool colours = kernel_view(frames.options_.show.show) == SHOW_COLOR;
  if (!frames.options_.refines || !colours) return {};
  return plan_refined(frames.layout_, frames.plan_.trace);
}

ViewFrames::ViewFrames(CheckedDevice& device, const OpenedScene& opened, const ViewOptions& options)
    : opened_(opened),
      options_(options),
      morton_bits_(options.builder.bits_for(opened.arrays.triangles)),
      motion_(motion_of(opened.scene)),
      layout_(device.properties().max_block_bytes),
      plan_(plan_all(*this, device)),
      refined_(plan_passes(*this)),
      executor_(device.device(), layout_),
      chooser_(options.update) {
  upload_scene();
  record();
}

// The device has to be done with what it was given.
ViewFrames::~ViewFrames() {
  if (!under_way_) return;
  for (std::optional<Recorder>* const recorder :
       {&tree_recorder_, &refit_recorder_, &trace_recorder_, &pass_recorder_}) {
    try {
      if (*recorder) (*recorder)->wait(piece_limit_seconds);
    } catch (const DeviceError&) {
      // Whoever asked for the frame has been told, or does not want to know.
    }
  }
}

// A tree of the host is there, and gets its wide nodes.
void ViewFrames::record_tree(bool rebuilds, std::vector<std::string>& groups,
                             std::optional<Recorder>& recorder) {
  Chain chain = executor_.chain();
  if (plan_.build) append_update(chain, rebuilds);
  append_moving_wide(chain, plan_, rebuilds);
  groups = mark_groups(chain.steps());
  if (!chain.steps().empty()) recorder.emplace(executor_.record(chain.steps()));
}

void ViewFrames::record() {
  record_tree(true, tree_groups_, tree_recorder_);
  if (refit_) record_tree(false, refit_groups_, refit_recorder_);
  Chain trace = executor_.chain();
  TracePieces pieces = plan_.pieces(plan_.trace);
  while (!pieces.done()) pieces.append(trace, ~std::uint64_t{0});
  trace_groups_ = mark_groups(trace.steps());
  trace_recorder_.emplace(executor_.record(trace.steps()));
}

void ViewFrames::wait(Recorder& recorder, const std::vector<std::string>& names, ViewedFrame& frame) {
  const Recorder::Times times = recorder.wait(piece_limit_seconds);
  frame.device_ms += times.total_ms;
  if (times.marks_ms.size() + 1 != names.size()) return;  // no timestamps
  double before = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double until = i < times.marks_ms.size() ? times.marks_ms[i] : times.total_ms;
    const auto same = std::ranges::find(frame.groups, names[i], &KernelGroup::name);
    if (same == frame.groups.end()) {
      frame.groups.push_back({names[i], until - before});
    } else {
      same->ms += until - before;
    }
    before = until;
  }
}

void ViewFrames::set_show(const ShowOptions& show) {
  options_.show = show;
  values_old_ = true;
}

ShowSpan ViewFrames::span(const Film& film) const {
  return span_of(options_.show, film, opened_.box, walk(), opened_.arrays.primitive_count());
}

// The place of each triangle in the order of the last sort, or the cluster it was in.
void ViewFrames::upload_values() {
  values_old_ = false;
  const Slot<uint>& slot = plan_.trace.show.primitive_values;
  if (slot.count == 0) return;
  std::vector<uint> values;
  if (options_.show.show == Show::morton) {
    const std::uint32_t primitives = opened_.arrays.primitive_count();
    values = plan_.build
                 ? ranks_in(executor_.read(Slot<uint>{plan_.build->values[0].place, primitives}), primitives)
                 : shown_values(options_.show, opened_.arrays.triangles, morton_bits_, {});
  } else {
    const std::vector<Node> nodes = tree();
    std::vector<PlocRound> rounds;
    if (plan_.build && plan_.build->rounds.count > 0) rounds = executor_.read(plan_.build->rounds);
    std::vector<Triangle> boxes;
    if (plan_.levels) boxes = corners_of(executor_.read(plan_.levels->plan.instance_boxes));
    values = shown_values(options_.show,
                          plan_.levels ? std::span<const Triangle>(boxes) : opened_.arrays.triangles,
                          morton_bits_, {nodes, rounds});
  }
  executor_.upload(slot, std::span<const uint>(values));
}

void ViewFrames::submit_tree(double seconds, bool rebuild) {
  const bool moved = can_move() && seconds_ != seconds, asked = rebuild && plan_.build;
  if (seconds_ && !moved && !asked) return;
  tell(seconds);
  if (asked) chooser_ = UpdateChooser(options_.update);  // which begins with a build
  const bool refits = chooser_.next_refits() && refit_;
  under_way_->frame.refitted = refits;
  under_way_->frame.built = !refits;
  under_way_->has_tree = refits || tree_recorder_;
  if (under_way_->has_tree) (refits ? *refit_recorder_ : *tree_recorder_).submit();
  seconds_ = seconds;
  values_old_ = true;
}

// False where a refit was in vain: a triangle that has appeared needs a tree with a leaf for it.
bool ViewFrames::wait_for_tree() {
  if (!std::exchange(under_way_->has_tree, false)) return true;
  ViewedFrame& frame = under_way_->frame;
  if (frame.built) {
    wait(*tree_recorder_, tree_groups_, frame);
    return true;
  }
  wait(*refit_recorder_, refit_groups_, frame);
  frame.refitted = appeared() == 0;
  return frame.refitted;
}

// In place of a refit that was in vain.
void ViewFrames::build_after_all() {
  ViewedFrame& frame = under_way_->frame;
  under_way_->in_vain = frame.built = true;
  tree_recorder_->submit();
  wait(*tree_recorder_, tree_groups_, frame);
}

void ViewFrames::submit(const Film& film, double seconds, bool rebuild) {
  under_way_ = UnderWay{.seconds = seconds};
  passed_samples_ = 0;
  executor_.upload(plan_.trace.film, std::span<const Film>(&film, 1));
  upload_show(executor_, plan_.trace.show, options_.show.show, span(film));
  submit_tree(seconds, rebuild);
  if (values_old_ && plan_.trace.show.primitive_values.count > 0) {  // they are made of the tree
    if (!wait_for_tree()) build_after_all();
    upload_values();
  }
  values_old_ = false;
  trace_recorder_->submit();
}

void ViewFrames::submit_pass(const Film& film, std::uint32_t samples) {
  under_way_ = UnderWay{.seconds = *seconds_, .is_pass = true};
  const std::uint32_t first = passed_samples_;
  passed_samples_ += samples;
  Film sequence = film;
  sequence.is_sequence = 1;
  sequence.samples = passed_samples_;
  executor_.upload(refined_->film, std::span<const Film>(&sequence, 1));
  Chain chain = executor_.chain();
  TracePieces pieces = plan_.pieces(plan_of_pass(*refined_, first, passed_samples_));
  while (!pieces.done()) pieces.append(chain, ~std::uint64_t{0});
  if (passed_samples_ >= 2) append_noise_sum(chain, refined_->noise, passed_samples_);
  append_resolved(chain, *refined_);
  pass_groups_ = mark_groups(chain.steps());
  pass_recorder_.emplace(executor_.record(chain.steps()));
  pass_recorder_->submit();
}

void ViewFrames::check_errors() const {
  std::uint32_t error_word = executor_.read(plan_.tree.state)[0].error_word;
  if (plan_.levels) {
    for (const BuildState& state : executor_.read(plan_.levels->plan.mesh_states))
      error_word |= state.error_word;
  }
  if (const std::string errors = describe_error_word(error_word); !errors.empty())
    throw DeviceError("the frame at second " + std::to_string(under_way_->seconds) + ": " + errors);
}

void ViewFrames::read_counts(ViewedFrame& frame) const {
  const auto counted = [&](const Slot<TraceCounters>& counters) {
    return counters.count > 0 ? counts_of(executor_.read(counters)[0]) : TraceCounts{};
  };
  frame.counts = counted(plan_.trace.counters);
  frame.shadow = counted(shadow_counters(plan_.trace));
  frame.occlusion = counted(plan_.trace.lights.occlusion_counters);
  frame.bounced = counted(plan_.trace.paths.bounce_counters);
}

void ViewFrames::take_pass(ViewedFrame& frame) {
  wait(*pass_recorder_, pass_groups_, frame);
  frame.samples = passed_samples_;
  if (frame.samples >= 2)
    frame.error = picture_error(executor_.read(noise_sum_of(refined_->noise))[0], plan_.trace.image.count);
}

ViewedFrame ViewFrames::take() {
  ViewedFrame& frame = under_way_->frame;
  if (!wait_for_tree()) {
    trace_recorder_->wait(piece_limit_seconds);  // of a tree that lacks a triangle
    build_after_all();
    trace_recorder_->submit();
  }
  const double update_ms = frame.device_ms;
  if (under_way_->is_pass) {
    take_pass(frame);
  } else {
    wait(*trace_recorder_, trace_groups_, frame);
  }
  check_errors();
  read_counts(frame);
  if (frame.built || frame.refitted)
    chooser_.note({frame.built, under_way_->in_vain, update_ms, frame.device_ms - update_ms,
                   frame.counts.steps + frame.shadow.steps + frame.occlusion.steps + frame.bounced.steps});
  if (plan_.trace.show.range.count > 0)
    frame.seen = seen_in(executor_.read(plan_.trace.show.range)[0], options_.show.show);
  const ViewedFrame taken = std::move(frame);
  under_way_.reset();
  return taken;
}

std::vector<Node> ViewFrames::tree() const {
  const BuildState state = executor_.read(plan_.tree.state)[0];
  const std::uint64_t count = plan_.build ? state.active_count ? 2 * std::uint64_t{state.active_count} - 1 : 0
                                          : plan_.tree.nodes.count;
  return executor_.read(Slot<Node>{plan_.tree.nodes.place, count});
}

ViewedTree ViewFrames::describe() const {
  const TreeQuality quality = measure_quality(tree());
  ViewedTree described{quality.nodes, quality.leaves, quality.depth, quality.sah, {}};
  if (!plan_.build || plan_.build->rounds.count == 0) return described;
  for (const PlocRound& round : executor_.read(plan_.build->rounds)) {
    if (round.cluster_count == 0) break;
    described.clusters.push_back(round.cluster_count);
  }
  return described;
}

std::uint64_t ViewFrames::device_bytes() const {
  std::uint64_t bytes = 0;
  for (const std::uint64_t block : layout_.block_bytes()) bytes += block;
  return bytes;
}

}  // namespace coppice
