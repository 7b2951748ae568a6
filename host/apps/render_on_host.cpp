#include <algorithm>
#include <chrono>

#include "analysis/cpu_tracer.h"
#include "apps/frame.h"
#include "apps/progress.h"
#include "apps/render_frame.h"
#include "pipeline/interruption.h"
#include "pipeline/pace.h"
#include "pipeline/trace_pieces.h"
#include "stages/cpu_executor.h"
#include "stages/stages.h"

namespace coppice {

namespace {

Bvh build_on_device(CheckedDevice& device, const SceneArrays& arrays, BuildReport& report,
                    const Options& options) {
  Layout layout(device.properties().max_block_bytes);
  const BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(arrays.triangles.size()),
                                    device.build_options(build_options_of(options, report.morton_bits)));
  GpuExecutor executor(device.device(), layout);
  executor.upload(plan.triangles, std::span<const Triangle>(arrays.triangles));
  report = measure_gpu_build(device, executor, plan, report, options);
  return {read_tree(executor, plan), executor.read(plan.state)[0].active_count, report.rounds};
}

// The device's chain, in pieces, with the independent tracer in the place of its tracer.
void trace_on_host(CpuExecutor& executor, const TreeSlots& tree, const TracePlan& trace, const Bvh& bvh,
                   std::span<const Triangle> triangles, RenderReport& report) {
  // So that Ctrl-C is heard soon.
  constexpr double target_ms = 200;
  Pace pace(target_ms, bvh.nodes.empty() ? (1u << 20) / (triangles.size() + 1) + 1 : 256);
  const InterruptionGuard guard;
  TracePieces pieces(tree, trace);
  Progress progress("tracing", 100);
  const auto start = std::chrono::steady_clock::now();
  while (!pieces.done()) {
    throw_if_interrupted();
    Chain chain = executor.chain();
    const auto piece_start = std::chrono::steady_clock::now();
    const std::uint64_t work = pieces.append(chain, pace.work());
    for (const Step& step : chain.steps()) {
      const TraceClosestArgs* const closest = args_of(step, stages::trace_closest);
      if (!closest) {
        executor.run(step);
        continue;
      }
      const TraceClosestArgs& args = *closest;
      const std::span<const Ray> rays(&args.rays[0], args.ray_count);
      const std::span<Hit> hits(&args.hits[0], args.ray_count);
      trace_all(bvh.nodes, triangles, rays, hits);
      report.rays += args.ray_count;
      report.hits += std::ranges::count_if(hits, [](const Hit& hit) { return hit.triangle != NO_TRIANGLE; });
    }
    pace.note(
        work,
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - piece_start).count());
    progress.advance(static_cast<std::uint32_t>(100 * report.rays / pieces.work()));
  }
  throw_if_interrupted();
  report.trace_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

RenderReport render_on_host(CheckedDevice* device, const Scene& scene, const Options& options) {
  const SceneArrays arrays = scene_arrays(scene);
  Options once = options;
  once.runs = options.frames;
  RenderReport report;
  report.trace_device = "host CPU";
  report.build = report_for(options, scene, arrays.triangles);
  Bvh bvh;
  if (find_device_builder(options.builder)) {
    bvh = build_on_device(*device, arrays, report.build, once);
  } else {
    report.build = measure_cpu_build(arrays.triangles, report.build, options.frames, bvh);
  }

  Layout layout(~std::uint64_t{0});
  const TreeSlots tree = plan_tree(layout, static_cast<std::uint32_t>(arrays.triangles.size()), 0);
  TraceOptions trace_options;
  trace_options.width = options.width;
  trace_options.height = options.height;
  trace_options.samples = options.samples;
  const TracePlan trace =
      plan_trace(layout, tree, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  CpuExecutor executor(layout);
  upload_frame(executor, tree, trace, arrays,
               make_film(scene, options.camera, options.width, options.height, options.samples));

  trace_on_host(executor, tree, trace, bvh, arrays.triangles, report);
  report.image = executor.read(trace.image);
  return report;
}

}  // namespace coppice
