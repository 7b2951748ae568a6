#include <algorithm>
#include <optional>

#include "apps/frame.h"
#include "apps/progress.h"
#include "apps/render_frame.h"
#include "pipeline/bounded_submits.h"
#include "pipeline/trace_pieces.h"
#include "pipeline/wide.h"

namespace coppice {

namespace {

void upload_tree(GpuExecutor& executor, const TreeSlots& tree, const Bvh& bvh) {
  if (!bvh.nodes.empty() && bvh.nodes[0].height > TRACE_STACK_LIMIT) {
    throw DeviceError("the tree is " + std::to_string(bvh.nodes[0].height) +
                      " levels deep, the device's tracer takes " + std::to_string(TRACE_STACK_LIMIT));
  }
  BuildState state{};
  state.active_count = bvh.active_count;
  executor.upload(tree.nodes, std::span<const Node>(bvh.nodes));
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));
}

struct FramePlan {
  std::optional<BuildPlan> build;  // on the device
  std::optional<WidePlan> wide;
  TreeSlots tree;
  TracePlan trace;
};

// What a frame submits before its trace: each in one submit, without steps where there is nothing to do.
struct TreeSteps {
  std::vector<Step> build;  // by a builder on the device
  std::vector<Step> wide;   // if the wide tree is walked
};

TreeSteps tree_steps(const GpuExecutor& executor, const FramePlan& plan) {
  Chain build = executor.chain(), wide = executor.chain();
  if (plan.build) append_build(build, *plan.build);
  if (plan.wide) append_wide(wide, plan.tree, *plan.wide);
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
  submit_pieces(executor, TracePieces(plan.tree, few, middle), compiling, Timestamps::total, [](auto&&) {});
  TracePieces pieces(plan.tree, trace, middle);
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

// Nothing is read back in between but times.
void measure_frames(GpuExecutor& executor, const TreeSteps& steps, const FramePlan& plan, Pace& pace,
                    std::uint32_t runs, TraceProgress& progress, RenderReport& report) {
  Recorder build = executor.record(steps.build), wide = executor.record(steps.wide);
  std::vector<double> build_ms, wide_ms, trace_ms, wall_ms;
  for (std::uint32_t run = 0; run < runs; ++run) {
    if (plan.build) {
      const Recorder::Times times = build.submit_and_wait(piece_limit_seconds);
      build_ms.push_back(times.total_ms);
      wall_ms.push_back(times.wall_ms);
    }
    if (plan.wide) wide_ms.push_back(wide.submit_and_wait(piece_limit_seconds).total_ms);
    double& ms = trace_ms.emplace_back(0);
    submit_pieces(executor, TracePieces(plan.tree, plan.trace), pace, Timestamps::total,
                  [&](const SubmittedPiece& piece) {
                    ms += piece.times.total_ms;
                    progress.add(piece.work);
                  });
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
                   const std::string& trace_events, RenderReport& report) {
  std::vector<Step> tree_steps = steps.build;
  tree_steps.insert(tree_steps.end(), steps.wide.begin(), steps.wide.end());
  const RunCounts counts = counts_of_trace(executor.read(plan.trace.counters)[0]);
  TraceEvents events;
  KernelSums tree_sums, sums;
  if (!tree_steps.empty()) {
    const KernelSplit split = split_time(executor, tree_steps, piece_limit_seconds);
    tree_sums.add(split.steps, split.times, counts_of_tree(executor, plan));
    events.add(split);
  }
  submit_pieces(executor, TracePieces(plan.tree, plan.trace), pace, Timestamps::every_step,
                [&](const SubmittedPiece& piece) {
                  sums.add(piece.steps, piece.times, counts);
                  if (!trace_events.empty()) events.add(piece.steps, piece.times);
                  progress.add(piece.work);
                });
  const auto limit =
      find_copy_limit(device.device(), std::max(tree_sums.largest_dispatch(), sums.largest_dispatch()));
  report.kernels = kernel_table(sums, limit, report.trace_ms);
  if (!tree_steps.empty()) {
    const double build_ms = plan.build ? report.build.build_ms.median : 0;
    report.build.kernels = kernel_table(tree_sums, limit, build_ms + report.wide_ms);
  }
  events.write(trace_events);
}

void describe_build(const CheckedDevice& device, const GpuExecutor& executor, const BuildPlan& build,
                    BuildReport& report) {
  report.device = device.properties().name;
  report.driver = device.properties().driver;
  report.variants = to_string(build.options.variants);
  report.lookback = build.options.lookback;
  report.rounds = executor.read(build.state)[0].round_count;
  report.rounds_bound = build.rounds_bound;
  describe_tree(report, read_tree(executor, build));
}

}  // namespace

RenderReport render_on_device(CheckedDevice& device, const Scene& scene, const Options& options,
                              TraceOptions trace_options, bool split) {
  const SceneArrays arrays = scene_arrays(scene);
  const auto triangle_count = static_cast<std::uint32_t>(arrays.triangles.size());
  const bool builds = find_device_builder(options.builder);
  RenderReport report;
  report.trace_device = device.properties().name + ", " + device.properties().driver;
  report.build = report_for(options, scene, arrays.triangles);
  Bvh bvh;
  if (!builds) report.build = measure_cpu_build(arrays.triangles, report.build, options.frames, bvh);

  Layout layout(device.properties().max_block_bytes);
  FramePlan plan;
  if (builds)
    plan.build = plan_build(layout, triangle_count,
                            device.build_options(build_options_of(options, report.build.morton_bits)));
  plan.tree = builds ? *plan.build : plan_tree(layout, triangle_count, bvh.nodes.size());
  trace_options.directional_light = scene.light.radiance != vec3(0);
  report.walks_wide = is_wide(trace_options.walk);
  if (report.walks_wide && builds) {
    plan.wide = plan_wide(layout, *plan.build, &*plan.build);
    plan.tree = *plan.build;
  } else if (report.walks_wide) {
    plan.wide = plan_wide(layout, plan.tree);
  }
  plan.trace =
      plan_trace(layout, plan.tree, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  GpuExecutor executor(device.device(), layout);
  upload_frame(executor, plan.tree, plan.trace, arrays,
               make_film(scene, options.camera, options.width, options.height, options.samples));
  if (!builds) upload_tree(executor, plan.tree, bvh);

  const InterruptionGuard guard;
  const TreeSteps steps = tree_steps(executor, plan);
  Pace pace = warm_up(executor, steps, plan, device.properties());
  TraceProgress progress(TracePieces(plan.tree, plan.trace).work(), options.frames + split);
  measure_frames(executor, steps, plan, pace, options.frames, progress, report);
  const RunCounts counts = counts_of_trace(executor.read(plan.trace.counters)[0]);
  report.rays = counts.rays;
  report.hits = counts.hits;
  report.steps = counts.steps;
  report.image = executor.read(plan.trace.image);
  for (const std::uint64_t bytes : layout.block_bytes()) report.build.device_bytes += bytes;
  if (builds) describe_build(device, executor, *plan.build, report.build);
  if (split) split_kernels(device, executor, steps, plan, pace, progress, options.trace_events, report);
  return report;
}

}  // namespace coppice
