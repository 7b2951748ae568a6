#include "measure/animate.h"

#include <chrono>

#include "analysis/tree_hash.h"
#include "measure/films.h"
#include "measure/measure_build.h"
#include "measure/progress.h"
#include "measure/trace_events.h"
#include "pipeline/bounded_submits.h"
#include "render/film.h"

namespace coppice {

namespace {

using AnimateClock = std::chrono::steady_clock;

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
    if (!frame.kept) ++(frame.rebuilt ? report_.rebuilds : report_.refits);
    const auto now = AnimateClock::now();
    const std::uint32_t number = under_way_.front();
    under_way_.pop_front();
    report_.frames.push_back({number, std::chrono::duration<double, std::milli>(now - last_done_).count(),
                              frame.vertices_ms, frame.update_ms, frame.wide_ms, frame.trace_ms,
                              frame.total_ms, frame.rebuilt, frame.sah, frame.state.active_count,
                              frame.counts.rays, frame.counts.hits, frame.counts.steps, frame.shadow.rays,
                              frame.shadow.hits, frame.occlusion.rays, frame.lobes, image_hash(frame.image)});
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

// The kernels of the last frame, built, each with a time of its own; tree by tree. First each part at once:
// which of them have work is read from what a run has left, and that of another tree or frame, or of a refit,
// may have had fewer rounds or levels.
void split_kernels(CheckedDevice& device, MovingFrames& frames, const AnimateRuns& runs,
                   AnimateReport& report) {
  const FramePlan& plan = frames.plan();
  KernelSums sums;
  TraceEvents events;
  double total_ms = 0;
  for (const MovingFrames::Part& part : frames.parts()) {
    frames.executor().record(part.steps).submit_and_wait(piece_limit_seconds);
    const KernelSplit split = split_time(frames.executor(), part.steps, piece_limit_seconds);
    RunCounts counts = counts_of_build(frames.executor(), part.build, plan.wide ? &*plan.wide : nullptr);
    const RunCounts trace = counts_of_picture(frames.executor(), plan.trace);
    counts.rays = trace.rays;
    counts.hits = trace.hits;
    counts.steps = trace.steps;
    counts.shadow = trace.shadow;
    counts.occlusion = trace.occlusion;
    counts.paths = trace.paths;
    sums.add(split.steps, split.times, counts);
    events.add(split);
    total_ms += split.times.total_ms;
  }
  report.kernels = kernel_table(sums, find_copy_limit(device, sums.largest_dispatch()), total_ms);
  if (!runs.trace_events.empty()) events.write(runs.trace_events, device);
}

}  // namespace

MovingOptions moving_options(const CheckedDevice& device, const AnimateRuns& runs,
                             std::uint32_t morton_bits) {
  return {.build = device.build_options(runs.builder.build_options(morton_bits)),
          .trace = runs.trace,
          .update = runs.update,
          .tree_cost = runs.tree_cost};
}

AnimateReport animate(CheckedDevice& device, const Scene& scene, SceneArrays arrays,
                      const AnimateRuns& runs) {
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
  report.walk = runs.trace.walk;
  report.tried = runs.tried;
  report.frames_per_second = runs.frames_per_second;
  report.update = runs.update;
  report.tree_cost = runs.tree_cost;
  MovingFrames frames(device.device(), scene, arrays, moving_options(device, runs, report.morton_bits));
  arrays = {};  // the device has them
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
