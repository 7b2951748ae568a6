#include "measure/animate.h"

#include <chrono>

#include "analysis/tree_hash.h"
#include "measure/measure_build.h"
#include "measure/progress.h"
#include "measure/trace_events.h"
#include "pipeline/bounded_submits.h"
#include "render/film.h"

namespace coppice {

namespace {

using AnimateClock = std::chrono::steady_clock;

// The film of any time, by the camera that moves where the scene still has one (stand_up); it is made once
// where the camera stands still.
class Films {
 public:
  Films(const Scene& scene, const AnimateRuns& runs)
      : motion_(runs.camera.empty() && scene.camera ? scene.motion.get() : nullptr),
        trace_(runs.trace),
        still_(make_film(scene, runs.camera, trace_.width, trace_.height, trace_.samples)) {}

  Film at(double seconds) const {
    if (!motion_) return still_;
    const std::optional<Camera> camera = pose_at(*motion_, seconds).camera;
    return camera ? make_film(*camera, trace_.width, trace_.height, trace_.samples) : still_;
  }

 private:
  const Motion* motion_;
  TraceOptions trace_;
  Film still_;
};

class FrameLoop {
 public:
  FrameLoop(const Films& films, const AnimateRuns& runs, MovingFrames& frames, AnimateReport& report)
      : films_(films), runs_(runs), frames_(frames), report_(report) {}

  void run() {
    const InterruptionGuard guard;
    Progress progress("frames", runs_.last - runs_.first + 1);
    for (std::uint32_t number = runs_.first; number <= runs_.last; ++number) {
      throw_if_interrupted();
      progress.step();
      if (runs_.skip && runs_.skip(number)) {
        ++report_.skipped;
        continue;
      }
      if (!frames_.has_room()) take();
      if (frames_.is_empty()) last_done_ = AnimateClock::now();
      const double seconds = number / runs_.frames_per_second;
      frames_.submit(seconds, films_.at(seconds));
      under_way_.push_back(number);
    }
    while (!frames_.is_empty()) take();
    throw_if_interrupted();
  }

 private:
  void take() {
    const MovingFrame frame = frames_.take();
    report_.host_waits += frame.submits;
    ++(frame.rebuilt ? report_.rebuilds : report_.refits);
    const auto now = AnimateClock::now();
    const std::uint32_t number = under_way_.front();
    under_way_.pop_front();
    report_.frames.push_back({number, std::chrono::duration<double, std::milli>(now - last_done_).count(),
                              frame.vertices_ms, frame.update_ms, frame.wide_ms, frame.trace_ms,
                              frame.total_ms, frame.rebuilt, frame.sah, frame.state.active_count,
                              frame.counts.rays, frame.counts.hits, frame.counts.steps,
                              image_hash(frame.image)});
    last_done_ = now;
    if (runs_.picture) runs_.picture(number, frame.image);
  }

  const Films& films_;
  const AnimateRuns& runs_;
  MovingFrames& frames_;
  AnimateReport& report_;
  std::deque<std::uint32_t> under_way_;
  AnimateClock::time_point last_done_;
};

// The kernels of the last frame that was told, each with a time of its own.
void split_kernels(CheckedDevice& device, MovingFrames& frames, const AnimateRuns& runs,
                   AnimateReport& report) {
  const KernelSplit split = split_time(frames.executor(), frames.steps(), piece_limit_seconds);
  const FramePlan& plan = frames.plan();
  RunCounts counts = counts_of_build(frames.executor(), *plan.build, plan.wide ? &*plan.wide : nullptr);
  const RunCounts trace = counts_of_trace(frames.executor().read(plan.trace.counters)[0]);
  counts.rays = trace.rays;
  counts.hits = trace.hits;
  counts.steps = trace.steps;
  KernelSums sums;
  sums.add(split.steps, split.times, counts);
  report.kernels = kernel_table(sums, find_copy_limit(device, sums.largest_dispatch()), split.times.total_ms);
  if (runs.trace_events.empty()) return;
  TraceEvents events;
  events.add(split);
  events.write(runs.trace_events, device);
}

}  // namespace

AnimateReport animate(CheckedDevice& device, const Scene& scene, const AnimateRuns& runs) {
  const SceneArrays arrays = scene_arrays(scene);
  AnimateReport report;
  report.scene = scene.name;
  report.builder = runs.builder.name;
  report.device = device.properties().name;
  report.driver = device.properties().driver;
  report.triangles = arrays.triangle_count();
  report.vertices = scene.positions.size();
  report.instances = scene.instances.size();
  report.morton_bits = runs.builder.bits_for(arrays.triangles);
  report.width = runs.trace.width;
  report.height = runs.trace.height;
  report.walks_wide = is_wide(runs.trace.walk);
  report.frames_per_second = runs.frames_per_second;
  report.update = runs.update;
  report.tree_cost = runs.tree_cost;
  const MovingOptions options{.build = device.build_options(runs.builder.build_options(report.morton_bits)),
                              .trace = runs.trace,
                              .update = runs.update,
                              .tree_cost = runs.tree_cost};
  MovingFrames frames(device.device(), scene, options);
  report.device_bytes = device_bytes(frames.layout());
  const Films films(scene, runs);
  const InterruptionGuard guard;
  const double first = runs.first / runs.frames_per_second;
  for (int warm_up = 0; warm_up < (runs.update == Update::rebuild ? 1 : 2); ++warm_up) {
    frames.submit(first, films.at(first));  // compiles the kernels: of a build, then of a refit
    frames.take();
  }
  frames.forget_times();
  FrameLoop(films, runs, frames, report).run();
  if (runs.split) split_kernels(device, frames, runs, report);
  return report;
}

}  // namespace coppice
