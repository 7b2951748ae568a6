#include <algorithm>
#include <optional>

#include "apps/frame.h"
#include "apps/render_frame.h"
#include "pipeline/wide.h"

namespace coppice {

namespace {

constexpr double limit_seconds = 600;

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

// The chain of one frame: with a builder on the device its build comes first, up to the first mark, then the
// wide tree if it is walked, up to the second.
struct FrameChain {
  std::vector<Step> steps;
  std::size_t tree_steps;
};

FrameChain frame_chain(const GpuExecutor& executor, const FramePlan& plan) {
  Chain chain = executor.chain();
  if (plan.build) append_build(chain, *plan.build);
  chain.mark();
  if (plan.wide) append_wide(chain, plan.tree, *plan.wide);
  const std::size_t tree_steps = chain.steps().size();
  chain.mark();
  append_trace(chain, plan.tree, plan.trace);
  return {chain.steps(), tree_steps};
}

// A short trace through all kernels: the first use of a kernel compiles it.
void warm_up(GpuExecutor& executor, FramePlan plan) {
  plan.trace.image.count = std::min<std::uint64_t>(plan.trace.image.count, 64);
  plan.trace.options.samples = 1;
  executor.record(frame_chain(executor, plan).steps).submit_and_wait(limit_seconds);
}

// One submit a frame, nothing read back in between.
void measure_frames(GpuExecutor& executor, const FrameChain& chain, const FramePlan& plan, std::uint32_t runs,
                    RenderReport& report) {
  Recorder recorder = executor.record(chain.steps);
  std::vector<double> build_ms, wide_ms, trace_ms, wall_ms;
  for (std::uint32_t run = 0; run < runs; ++run) {
    const Recorder::Times times = recorder.submit_and_wait(limit_seconds);
    build_ms.push_back(times.marks_ms.at(0));
    wide_ms.push_back(times.marks_ms.at(1) - times.marks_ms[0]);
    trace_ms.push_back(times.total_ms - times.marks_ms[1]);
    wall_ms.push_back(times.wall_ms);
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

void split_kernels(CheckedDevice& device, GpuExecutor& executor, const FrameChain& chain,
                   const FramePlan& plan, const Options& options, RenderReport& report) {
  const std::span<const Step> steps = chain.steps;
  const KernelSplit tree_split = split_time(executor, steps.first(chain.tree_steps), limit_seconds);
  const RunCounts tree_counts = counts_of_tree(executor, plan);
  const KernelSplit split = split_time(executor, steps.subspan(chain.tree_steps), limit_seconds);
  const RunCounts counts = counts_of_trace(executor.read(plan.trace.counters)[0]);
  const auto limit = find_copy_limit(
      device.device, std::max(largest_dispatch(tree_split, tree_counts), largest_dispatch(split, counts)));
  report.kernels = kernel_table(split, counts, limit, report.trace_ms);
  if (plan.build || plan.wide) {
    const double build_ms = plan.build ? report.build.build_ms.median : 0;
    report.build.kernels = kernel_table(tree_split, tree_counts, limit, build_ms + report.wide_ms);
  }
  if (options.trace_events.empty()) return;
  write_trace_events(options.trace_events, split_time(executor, steps, limit_seconds));
}

void describe_build(const CheckedDevice& device, const GpuExecutor& executor, const BuildPlan& build,
                    BuildReport& report) {
  report.device = device.device.properties().name;
  report.driver = device.device.properties().driver;
  report.variants = to_string(build.options.variants);
  report.lookback = build.options.lookback;
  report.rounds = executor.read(build.state)[0].round_count;
  report.rounds_bound = build.rounds_bound;
  describe_tree(report, read_tree(executor, build));
}

}  // namespace

RenderReport render_on_device(CheckedDevice& device, const Scene& scene, const Options& options) {
  const SceneArrays arrays = scene_arrays(scene);
  const auto triangle_count = static_cast<std::uint32_t>(arrays.triangles.size());
  const bool builds = find_device_builder(options.builder);
  RenderReport report;
  report.trace_device = device.device.properties().name + ", " + device.device.properties().driver;
  report.build = report_for(options, scene, arrays.triangles);
  Bvh bvh;
  if (!builds) report.build = measure_cpu_build(arrays.triangles, report.build, options.frames, bvh);

  Layout layout(device.device.properties().max_block_bytes);
  FramePlan plan;
  if (builds)
    plan.build = plan_build(layout, triangle_count, device.build_options(options, report.build.morton_bits));
  plan.tree = builds ? *plan.build : plan_tree(layout, triangle_count, bvh.nodes.size());
  TraceOptions trace_options = device.trace_options(options);
  trace_options.directional_light = scene.light.radiance != vec3(0);
  trace_options.wide = report.walks_wide = device.walks_wide(options, triangle_count);
  if (trace_options.wide && builds) {
    plan.wide = plan_wide(layout, *plan.build, &*plan.build);
    plan.tree = *plan.build;
  } else if (trace_options.wide) {
    plan.wide = plan_wide(layout, plan.tree);
  }
  plan.trace =
      plan_trace(layout, plan.tree, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  GpuExecutor executor(device.device, layout);
  upload_frame(executor, plan.tree, plan.trace, arrays,
               make_film(scene, options.camera, options.width, options.height, options.samples));
  if (!builds) upload_tree(executor, plan.tree, bvh);

  warm_up(executor, plan);
  const FrameChain chain = frame_chain(executor, plan);
  measure_frames(executor, chain, plan, options.frames, report);
  const RunCounts counts = counts_of_trace(executor.read(plan.trace.counters)[0]);
  report.rays = counts.rays;
  report.hits = counts.hits;
  report.steps = counts.steps;
  report.image = executor.read(plan.trace.image);
  for (const std::uint64_t bytes : layout.block_bytes()) report.build.device_bytes += bytes;
  if (builds) describe_build(device, executor, *plan.build, report.build);
  if (options.kernels || !options.json.empty() || !options.trace_events.empty()) {
    split_kernels(device, executor, chain, plan, options, report);
  }
  return report;
}

}  // namespace coppice
