#include "apps/frame.h"
#include "apps/render_frame.h"

namespace coppice {

namespace {

constexpr double limit_seconds = 600;

std::uint64_t wide(uvec2 words) { return std::uint64_t{words.y} << 32 | words.x; }

// A short trace through all kernels: the first use of a kernel compiles it.
void warm_up(GpuExecutor& executor, const BuildPlan& build, TracePlan trace, bool builds) {
  trace.image.count = std::min<std::uint64_t>(trace.image.count, 64);
  trace.options.samples = 1;
  Chain chain = executor.chain();
  if (builds) append_build(chain, build);
  append_trace(chain, build, trace);
  executor.record(chain.steps()).submit_and_wait(limit_seconds);
}

void upload_tree(GpuExecutor& executor, const BuildPlan& plan, const Bvh& bvh) {
  if (!bvh.nodes.empty() && bvh.nodes[0].height > TRACE_STACK_LIMIT) {
    throw DeviceError("the tree is " + std::to_string(bvh.nodes[0].height) +
                      " levels deep, the device's tracer takes " + std::to_string(TRACE_STACK_LIMIT));
  }
  BuildState state{};
  state.active_count = bvh.active_count;
  executor.upload(plan.nodes, std::span<const Node>(bvh.nodes));
  executor.upload(plan.state, std::span<const BuildState>(&state, 1));
}

}  // namespace

RenderReport render_on_device(CheckedDevice& device, const Scene& scene, const Options& options) {
  const SceneArrays arrays = scene_arrays(scene);
  const auto triangle_count = static_cast<std::uint32_t>(arrays.triangles.size());
  Layout layout(device.device.properties().max_block_bytes);
  const BuildPlan build = plan_build(layout, triangle_count, device.build_options(options));
  TraceOptions trace_options = device.trace_options(options);
  trace_options.directional_light = scene.light.radiance != vec3(0);
  const TracePlan trace =
      plan_trace(layout, build, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  GpuExecutor executor(device.device, layout);
  upload_frame(executor, build, trace, arrays,
               make_film(scene, options.camera, options.width, options.height, options.samples));

  RenderReport report;
  report.build = report_for(options, scene);
  const bool builds = options.builder == "gpu-ploc";
  if (!builds) {
    Options once = options;
    once.runs = 1;
    Bvh bvh;
    report.build = measure_cpu_build(arrays.triangles, report.build, once, bvh);
    upload_tree(executor, build, bvh);
  }
  warm_up(executor, build, trace, builds);

  Chain chain = executor.chain();
  if (builds) append_build(chain, build);
  const std::size_t build_steps = chain.steps().size();
  chain.mark();
  append_trace(chain, build, trace);
  Recorder recorder = executor.record(chain.steps());
  const Recorder::Times times = recorder.submit_and_wait(limit_seconds);
  check_state(executor, build);

  report.trace_ms = times.total_ms - times.marks_ms.at(0);
  const TraceCounters counters = executor.read(trace.counters)[0];
  report.rays = wide(counters.rays);
  report.hits = wide(counters.hits);
  report.steps = wide(counters.steps);
  report.image = executor.read(trace.image);
  if (builds) {
    report.build.device = device.device.properties().name;
    report.build.driver = device.device.properties().driver;
    report.build.build_ms = {times.marks_ms[0], times.marks_ms[0], times.marks_ms[0]};
    report.build.wall_ms = {times.wall_ms, times.wall_ms, times.wall_ms};
    report.build.runs = 1;
    report.build.rounds = executor.read(build.state)[0].round_count;
    report.build.rounds_bound = build.rounds_bound;
    for (const std::uint64_t bytes : layout.block_bytes()) report.build.device_bytes += bytes;
    describe_tree(report.build, read_tree(executor, build));
  }
  if (!options.json.empty() || !options.trace_events.empty()) {
    const std::span<const Step> steps = chain.steps();
    if (builds) {
      const KernelSplit split = split_time(executor, steps.first(build_steps), limit_seconds);
      report.build.kernels = kernel_times(split.steps, split.times);
      for (const KernelTime& kernel : report.build.kernels) report.build.dispatches += kernel.dispatches;
    }
    const KernelSplit split = split_time(executor, steps.subspan(build_steps), limit_seconds);
    report.kernels = kernel_times(split.steps, split.times);
    if (!options.trace_events.empty()) {
      const KernelSplit whole = split_time(executor, steps, limit_seconds);
      write_trace_events(options.trace_events, whole.steps, whole.times);
    }
  }
  return report;
}

}  // namespace coppice
