#include <algorithm>
#include <optional>

#include "apps/frame.h"
#include "apps/render_frame.h"

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

// The chain of one frame: with a builder on the device its build comes first, up to the mark.
struct FrameChain {
  std::vector<Step> steps;
  std::size_t build_steps;
};

FrameChain frame_chain(const GpuExecutor& executor, const BuildPlan* build, const TreeSlots& tree,
                       const TracePlan& trace) {
  Chain chain = executor.chain();
  if (build) append_build(chain, *build);
  const std::size_t build_steps = chain.steps().size();
  chain.mark();
  append_trace(chain, tree, trace);
  return {chain.steps(), build_steps};
}

// A short trace through all kernels: the first use of a kernel compiles it.
void warm_up(GpuExecutor& executor, const BuildPlan* build, const TreeSlots& tree, TracePlan trace) {
  trace.image.count = std::min<std::uint64_t>(trace.image.count, 64);
  trace.options.samples = 1;
  executor.record(frame_chain(executor, build, tree, trace).steps).submit_and_wait(limit_seconds);
}

// One submit a frame, nothing read back in between.
void measure_frames(GpuExecutor& executor, const FrameChain& chain, const TreeSlots& tree, bool builds,
                    std::uint32_t runs, RenderReport& report) {
  Recorder recorder = executor.record(chain.steps);
  std::vector<double> build_ms, trace_ms, wall_ms;
  for (std::uint32_t run = 0; run < runs; ++run) {
    const Recorder::Times times = recorder.submit_and_wait(limit_seconds);
    build_ms.push_back(times.marks_ms.at(0));
    trace_ms.push_back(times.total_ms - times.marks_ms[0]);
    wall_ms.push_back(times.wall_ms);
    check_state(executor, tree);
  }
  report.trace_ms = spread_of(trace_ms).median;
  if (!builds) return;
  report.build.build_ms = spread_of(build_ms);
  report.build.wall_ms = spread_of(wall_ms);
  report.build.runs = runs;
}

void split_kernels(CheckedDevice& device, GpuExecutor& executor, const FrameChain& chain,
                   const BuildPlan* build, const TracePlan& trace, const Options& options,
                   RenderReport& report) {
  const std::span<const Step> steps = chain.steps;
  KernelSplit build_split;
  RunCounts build_counts;
  if (build) {
    build_split = split_time(executor, steps.first(chain.build_steps), limit_seconds);
    build_counts = counts_of_build(executor, *build);
  }
  const KernelSplit split = split_time(executor, steps.subspan(chain.build_steps), limit_seconds);
  const RunCounts counts = counts_of_trace(executor.read(trace.counters)[0]);
  const auto limit = find_copy_limit(
      device.device, std::max(largest_dispatch(build_split, build_counts), largest_dispatch(split, counts)));
  report.kernels = kernel_table(split, counts, limit, report.trace_ms);
  if (build)
    report.build.kernels = kernel_table(build_split, build_counts, limit, report.build.build_ms.median);
  if (options.trace_events.empty()) return;
  write_trace_events(options.trace_events, split_time(executor, steps, limit_seconds));
}

void describe_build(const CheckedDevice& device, const GpuExecutor& executor, const BuildPlan& build,
                    BuildReport& report) {
  report.device = device.device.properties().name;
  report.driver = device.device.properties().driver;
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
  std::optional<BuildPlan> build;
  if (builds)
    build = plan_build(layout, triangle_count, device.build_options(options, report.build.morton_bits));
  const TreeSlots tree = builds ? *build : plan_tree(layout, triangle_count, bvh.nodes.size());
  TraceOptions trace_options = device.trace_options(options);
  trace_options.directional_light = scene.light.radiance != vec3(0);
  const TracePlan trace =
      plan_trace(layout, tree, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  GpuExecutor executor(device.device, layout);
  upload_frame(executor, tree, trace, arrays,
               make_film(scene, options.camera, options.width, options.height, options.samples));
  if (!builds) upload_tree(executor, tree, bvh);

  const BuildPlan* const device_build = builds ? &*build : nullptr;
  warm_up(executor, device_build, tree, trace);
  const FrameChain chain = frame_chain(executor, device_build, tree, trace);
  measure_frames(executor, chain, tree, builds, options.frames, report);
  const RunCounts counts = counts_of_trace(executor.read(trace.counters)[0]);
  report.rays = counts.rays;
  report.hits = counts.hits;
  report.steps = counts.steps;
  report.image = executor.read(trace.image);
  for (const std::uint64_t bytes : layout.block_bytes()) report.build.device_bytes += bytes;
  if (builds) describe_build(device, executor, *build, report.build);
  if (options.kernels || !options.json.empty() || !options.trace_events.empty()) {
    split_kernels(device, executor, chain, device_build, trace, options, report);
  }
  return report;
}

}  // namespace coppice
