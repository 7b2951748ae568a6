#include "render/moving_frames.h"

#include <stdexcept>

#include "pipeline/bounded_submits.h"
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

TraceOptions trace_options_of(const Scene& scene, TraceOptions options) {
  options.directional_light = scene.light.radiance != vec3(0);
  return options;
}

}  // namespace

FramePlan MovingFrames::plan_all(MovingFrames& frames, const SceneArrays& arrays) {
  Layout& layout = frames.layout_;
  frames.vertices_ = plan_vertices(layout, frames.motion_, arrays.triangle_count());
  const FrameOptions options{.build = frames.options_.build, .trace = frames.options_.trace};
  FramePlan plan = plan_frame(layout, arrays, options);
  for (std::uint32_t i = 0; i < frames.options_.under_way; ++i) {
    frames.slots_.push_back({{plan_motion(layout, frames.motion_), layout.add_mapped<Film>("film_told", 1)},
                             {layout.add_mapped<uint>("image_left", plan.trace.image.count),
                              layout.add_mapped<BuildState>("state_left", 1),
                              layout.add_mapped<TraceCounters>("counters_left", 1)}});
  }
  return plan;
}

MovingFrames::MovingFrames(Device& device, const Scene& scene, const MovingOptions& options)
    : motion_(motion_of(scene)),
      options_{options.build, trace_options_of(scene, options.trace), options.under_way},
      layout_(device.properties().max_block_bytes),
      plan_(plan_all(*this, scene_arrays(scene))),
      executor_(device, layout_) {
  if (options_.under_way == 0) throw std::invalid_argument("no frame may be under way");
  upload_frame(executor_, plan_.tree, plan_.trace, scene_arrays(scene), Film{});
  upload_vertices(executor_, vertices_, motion_, std::span<const uvec3>(scene.indices));
  for (const FrameSlots& slots : slots_) {
    Chain chain = executor_.chain();
    append(chain, slots);
    recorders_.push_back(executor_.record(chain.steps()));
  }
}

// The device has to be done with what it is given.
MovingFrames::~MovingFrames() {
  try {
    while (!waiting_.empty()) take();
  } catch (const DeviceError&) {
    // Whoever asked for the frames has been told, or does not want to know.
  }
}

void MovingFrames::append(Chain& chain, const FrameSlots& slots) const {
  append_vertices(chain, vertices_, slots.told.motion, motion_);
  chain.mark();
  append_build(chain, *plan_.build, {triangles_of(chain, vertices_), {}});
  chain.mark();
  append_frame_wide(chain, plan_);
  chain.mark();
  TracePlan trace = plan_.trace;
  trace.film = slots.told.film;
  trace.image = slots.left.image;
  append_trace(chain, plan_.tree, trace);
  append_copy_out(chain, plan_.tree.state, slots.left.state);
  append_copy_out(chain, trace.counters, slots.left.counters);
}

std::vector<Step> MovingFrames::steps() const {
  Chain chain = executor_.chain();
  append(chain, slots_.front());
  return std::move(chain.steps());
}

void MovingFrames::submit(double seconds, const Film& film) {
  if (!has_room()) throw std::logic_error("as many frames as there may be are under way");
  const FrameSlots& slots = slots_[next_slot_];
  upload_step(executor_, slots.told.motion, motion_step(motion_, pose_at(motion_, seconds), seconds));
  executor_.upload(slots.told.film, std::span<const Film>(&film, 1));
  recorders_[next_slot_].submit();
  waiting_.push_back({next_slot_, seconds});
  next_slot_ = (next_slot_ + 1) % slots_.size();
}

template <class T>
const T* MovingFrames::mapped(const Slot<T>& slot) {
  return reinterpret_cast<const T*>(executor_.arena().mapped(slot.place.block) + slot.place.offset);
}

MovingFrame MovingFrames::take() {
  if (waiting_.empty()) throw std::logic_error("no frame is under way");
  const Waiting waiting = waiting_.front();
  const Recorder::Times times = recorders_[waiting.slot].wait(piece_limit_seconds);
  waiting_.pop_front();
  const Left& left = slots_[waiting.slot].left;
  MovingFrame frame;
  frame.seconds = waiting.seconds;
  frame.total_ms = times.total_ms;
  frame.wall_ms = times.wall_ms;
  if (!times.marks_ms.empty()) {
    frame.vertices_ms = times.marks_ms[0];
    frame.build_ms = times.marks_ms[1] - times.marks_ms[0];
    frame.wide_ms = times.marks_ms[2] - times.marks_ms[1];
    frame.trace_ms = times.total_ms - times.marks_ms[2];
  }
  frame.state = *mapped(left.state);
  frame.counts = counts_of(*mapped(left.counters));
  frame.image = {mapped(left.image), left.image.count};
  const std::string errors = describe_error_word(frame.state.error_word);
  if (!errors.empty())
    throw DeviceError("the frame at second " + std::to_string(frame.seconds) + ": " + errors);
  return frame;
}

}  // namespace coppice
