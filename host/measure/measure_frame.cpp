#include "measure/measure_frame.h"

#include <algorithm>
#include <functional>

#include "measure/measure_build.h"
#include "measure/progress.h"
#include "measure/show_frame.h"
#include "measure/trace_events.h"
#include "pipeline/bounded_submits.h"
#include "pipeline/trace_pieces.h"
#include "render/box_lines.h"
#include "render/frame.h"

namespace coppice {

namespace {

// What a frame submits before its trace: each in one submit, without steps where there is nothing to do.
struct TreeSteps {
  std::vector<Step> build;  // by a builder on the device
  std::vector<Step> wide;   // if the wide tree is walked
};

TreeSteps tree_steps(const GpuExecutor& executor, const FramePlan& plan) {
  Chain build = executor.chain(), wide = executor.chain();
  append_frame_build(build, plan);
  append_frame_wide(wide, plan);
  return {build.steps(), wide.steps()};
}

// Builds the tree, and traces a little in the middle of the picture: the first use of a kernel compiles it,
// and how fast the device is is seen. Returns the pace of the frames to come.
Pace warm_up(GpuExecutor& executor, const TreeSteps& steps, const FramePlan& plan,
             const DeviceProperties& device) {
  for (const std::vector<Step>* const part : {&steps.build, &steps.wide}) {
    if (!part->empty()) executor.record(*part).submit_and_wait(piece_limit_seconds);
  }
  TracePlan trace = plan.trace;
  trace.options.samples = 1;
  const auto middle = static_cast<std::uint32_t>(trace.image.count / 2 / RANGE_RAYS * RANGE_RAYS);
  TracePlan few = trace;
  few.image.count = std::min<std::uint64_t>(trace.image.count, middle + RANGE_RAYS);
  const Pace unknown(submit_target_ms(device), first_work(trace.options));
  Pace compiling = unknown, pace = unknown;
  submit_pieces(executor, plan.pieces(few, middle), compiling, Timestamps::total, [](auto&&) {});
  TracePieces pieces = plan.pieces(trace, middle);
  const double enough_ms = pace.target_ms() / 20;
  for (double ms = 0; !pieces.done() && ms < enough_ms;)
    ms += submit_piece(executor, pieces, pace, Timestamps::total).times.wall_ms;
  return pace;
}

// A bar over all pieces of several traces.
class TraceProgress {
 public:
  TraceProgress(std::uint64_t work, std::uint32_t traces)
      : percent_per_work_(100 / (static_cast<double>(work) * traces)), bar_("tracing", 100) {}
  void add(std::uint64_t work) {
    percent_ = std::min(percent_ + static_cast<double>(work) * percent_per_work_, 100.0);
    bar_.advance(static_cast<std::uint32_t>(percent_));
  }

 private:
  double percent_per_work_, percent_ = 0;
  Progress bar_;
};

// Seconds that the passes took, of the host's clock, are those of all their submits.
// Returns milliseconds of the device's clock.
double refine_frame(GpuExecutor& executor, const FramePlan& plan, Film& film, Pace& pace,
                    const RefineLimits& limits, std::optional<Refined>& refined) {
  double ms = 0;
  const auto submit = [&](const auto& append) {
    Chain chain = executor.chain();
    append(chain);
    return executor.record(chain.steps()).submit_and_wait(piece_limit_seconds);
  };
  const NoiseSlots& noise = plan.trace.noise;
  const auto pass = [&](std::uint32_t first, std::uint32_t end) {
    double wall_ms = 0;
    TracePlan trace = plan_of_pass(plan.trace, first, end);
    if (is_of_some_pixels(limits, first)) {
      const Recorder::Times times =
          submit([&](Chain& chain) { append_active_pixels(chain, noise, plan.tree.state, limits.error); });
      ms += times.total_ms;
      wall_ms += times.wall_ms;
      trace.traced_pixels = {noise.pixels.place, executor.read(noise.active_count)[0]};
      if (trace.traced_pixels.count == 0) return wall_ms / 1000;
    }
    submit_pieces(executor, plan.pieces(trace), pace, Timestamps::total, [&](const SubmittedPiece& piece) {
      ms += piece.times.total_ms;
      wall_ms += piece.times.wall_ms;
    });
    return wall_ms / 1000;
  };
  const auto error = [&](std::uint32_t samples) {
    submit([&](Chain& chain) { append_noise_sum(chain, noise, samples); });
    return picture_error(executor.read(noise_sum_of(noise))[0], plan.trace.image.count);
  };
  refined = refine(limits, pass, error);
  film.samples = refined->samples;
  executor.upload(plan.trace.film, std::span<const Film>(&film, 1));
  return ms + submit([&](Chain& chain) { append_resolved(chain, plan.trace); }).total_ms;
}

// The same of a picture of as many samples as it is planned with.
double trace_frame(GpuExecutor& executor, const FramePlan& plan, Pace& pace, TraceProgress& progress) {
  double ms = 0;
  submit_pieces(executor, plan.pieces(plan.trace), pace, Timestamps::total, [&](const SubmittedPiece& piece) {
    ms += piece.times.total_ms;
    progress.add(piece.work);
  });
  return ms;
}

// Nothing is read back in between but times.
void measure_frames(GpuExecutor& executor, const TreeSteps& steps, const FramePlan& plan, std::uint32_t runs,
                    const std::function<double()>& trace, FrameReport& report) {
  Recorder build = executor.record(steps.build), wide = executor.record(steps.wide);
  std::vector<double> build_ms, wide_ms, trace_ms, wall_ms;
  for (std::uint32_t run = 0; run < runs; ++run) {
    if (plan.build) {
      const Recorder::Times times = build.submit_and_wait(piece_limit_seconds);
      build_ms.push_back(times.total_ms);
      wall_ms.push_back(times.wall_ms);
    }
    if (plan.wide) wide_ms.push_back(wide.submit_and_wait(piece_limit_seconds).total_ms);
    trace_ms.push_back(trace());
    check_state(executor, plan.tree);
  }
  report.trace_ms = spread_of(trace_ms).median;
  if (plan.wide) report.wide_ms = spread_of(wide_ms).median;
  if (!plan.build) return;
  report.build.build_ms = spread_of(build_ms);
  report.build.wall_ms = spread_of(wall_ms);
  report.build.runs = runs;
}

RunCounts counts_of_tree(const GpuExecutor& executor, const FramePlan& plan) {
  const WidePlan* const wide = plan.wide ? &*plan.wide : nullptr;
  if (plan.build) return counts_of_build(executor, *plan.build, wide);
  RunCounts counts;
  counts.active_count = executor.read(plan.tree.state)[0].active_count;
  if (wide) count_wide(executor, plan.tree, *wide, counts);
  return counts;
}

// The frame once more, with a timestamp after each dispatch.
void split_kernels(CheckedDevice& device, GpuExecutor& executor, const TreeSteps& steps,
                   const FramePlan& plan, Pace& pace, TraceProgress& progress,
                   const std::string& trace_events, FrameReport& report) {
  // Of two levels the upper one: the counts that are left are its.
  std::vector<Step> tree_steps = steps.build;
  if (plan.levels) {
    Chain top = executor.chain();
    append_top(top, plan.levels->plan);
    tree_steps = top.steps();
  }
  tree_steps.insert(tree_steps.end(), steps.wide.begin(), steps.wide.end());
  const RunCounts counts = counts_of_picture(executor, plan.trace);
  TraceEvents events;
  KernelSums tree_sums, sums;
  if (!tree_steps.empty()) {
    const KernelSplit split = split_time(executor, tree_steps, piece_limit_seconds);
    tree_sums.add(split.steps, split.times, counts_of_tree(executor, plan));
    events.add(split);
  }
  double trace_ms = report.trace_ms;
  TracePlan trace = plan.trace;
  if (report.refined) {
    trace.options.samples = 1;
    trace_ms /= report.refined->samples;
  }
  submit_pieces(executor, plan.pieces(trace), pace, Timestamps::every_step, [&](const SubmittedPiece& piece) {
    sums.add(piece.steps, piece.times, counts);
    if (!trace_events.empty()) events.add(piece.steps, piece.times);
    progress.add(piece.work);
  });
  const auto limit = find_copy_limit(device, std::max(tree_sums.largest_dispatch(), sums.largest_dispatch()));
  report.kernels = kernel_table(sums, limit, trace_ms);
  if (!tree_steps.empty()) {
    const double build_ms = plan.build ? report.build.build_ms.median : 0;
    report.build.kernels = kernel_table(tree_sums, limit, build_ms + report.wide_ms);
  }
  events.write(trace_events, device);
}

// What is shown of the tree that the warm-up has built.
void upload_shown(GpuExecutor& executor, const FramePlan& plan, const SceneArrays& arrays,
                  FrameReport& report) {
  const ShowSlots& slots = plan.trace.show;
  upload_show(executor, slots, report.shown.options.show, report.shown.scale);
  if (slots.primitive_values.count == 0) return;
  const std::vector<Node> nodes = read_tree(executor, plan.tree);
  std::vector<PlocRound> rounds;
  if (plan.build && plan.build->rounds.count > 0) rounds = executor.read(plan.build->rounds);
  std::vector<Triangle> boxes;
  if (plan.levels) boxes = corners_of(executor.read(plan.levels->plan.instance_boxes));
  const std::vector<uint> values =
      shown_values(report.shown.options, plan.levels ? std::span<const Triangle>(boxes) : arrays.triangles,
                   report.build.morton_bits, {nodes, rounds});
  report.shown.clusters = count_groups(values, nodes);
  executor.upload(slots.primitive_values, std::span<const uint>(values));
}

// The picture, and what was seen in it.
void read_picture(const GpuExecutor& executor, const FramePlan& plan, const Film& film, FrameReport& report) {
  report.image = executor.read(plan.trace.image);
  if (plan.trace.options.keep_radiance)
    report.radiance = mean_radiance(executor.read(plan.trace.radiance), film.width, film.height, film.samples,
                                    executor.read(plan.trace.noise.sample_counts));
  const ShowOptions& show = report.shown.options;
  if (plan.trace.show.range.count > 0)
    report.shown.seen = seen_in(executor.read(plan.trace.show.range)[0], show.show);
  if (show.show != Show::boxes) return;
  const std::vector<BoxLine> lines = box_lines(read_tree(executor, plan.tree), film, show.level, BOXES_SHOWN);
  draw_box_lines(report.image, film.width, film.height, lines, show.level);
}

}  // namespace

FrameReport measure_frame(CheckedDevice& device, const Scene& scene, const SceneArrays& arrays,
                          const FrameRuns& frame) {
  FrameReport report;
  report.trace_device = device.properties().name + ", " + device.properties().driver;
  report.build = report_for(frame.builder, scene, arrays.triangles, device.notes());
  FrameOptions options{.trace = frame.trace};
  options.trace.directional_light = scene.light.radiance != vec3(0);
  options.trace.show = kernel_view(frame.show.show);
  options.trace.keep_noise = frame.refine.any();
  options.trace.adaptive = frame.refine.adaptive;
  Bvh bvh;
  if (frame.builder.on_device()) {
    options.build = device.build_options(frame.builder.build_options(report.build.morton_bits));
  } else {
    report.build = measure_cpu_build(arrays.triangles, report.build, frame.runs, bvh);
    options.node_count = bvh.nodes.size();
  }
  report.walks_wide = is_wide(options.trace.walk);

  Layout layout(device.properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  GpuExecutor executor(device.device(), layout);
  Film film = make_film(scene, frame.camera, frame.trace.width, frame.trace.height, frame.trace.samples);
  film.is_sequence = frame.refine.any();
  upload_frame(executor, plan, arrays, film);
  report.shown.options = frame.show;
  report.shown.scale =
      span_of(frame.show, film, box_of_scene(scene, arrays), options.trace.walk, arrays.primitive_count());
  if (!plan.build) upload_bvh(executor, plan.tree, bvh);

  const InterruptionGuard guard;
  const TreeSteps steps = tree_steps(executor, plan);
  Pace pace = warm_up(executor, steps, plan, device.properties());
  upload_shown(executor, plan, arrays, report);
  TraceProgress progress(plan.pieces(plan.trace).work(), frame.runs + frame.split);
  const auto trace = [&] {
    return frame.refine.any() ? refine_frame(executor, plan, film, pace, frame.refine, report.refined)
                              : trace_frame(executor, plan, pace, progress);
  };
  measure_frames(executor, steps, plan, frame.runs, trace, report);
  const RunCounts counts = counts_of_picture(executor, plan.trace);
  report.rays = counts.rays;
  report.hits = counts.hits;
  report.steps = counts.steps;
  report.shadow = {counts.shadow.rays, counts.shadow.hits, counts.shadow.steps};
  report.occlusion = {counts.occlusion.rays, counts.occlusion.hits, counts.occlusion.steps};
  report.bounced = {counts.paths.rays, counts.paths.hits, counts.paths.steps};
  report.lobes = counts.lobes;
  read_picture(executor, plan, film, report);
  report.build.device_bytes = device_bytes(layout);
  if (plan.build) describe_device_build(device, executor, *plan.build, report.build);
  if (frame.split) split_kernels(device, executor, steps, plan, pace, progress, frame.trace_events, report);
  return report;
}

}  // namespace coppice
