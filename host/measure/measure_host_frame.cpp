#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>

#include "analysis/cpu_tracer.h"
#include "measure/measure_build.h"
#include "measure/measure_frame.h"
#include "measure/progress.h"
#include "measure/show_frame.h"
#include "pipeline/interruption.h"
#include "pipeline/pace.h"
#include "pipeline/trace_pieces.h"
#include "render/box_lines.h"
#include "render/frame.h"
#include "stages/cpu_executor.h"
#include "stages/stages.h"
#include "twins/alpha.h"

namespace coppice {

namespace {

std::uint64_t count_hits(std::span<const Hit> hits) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(hits, [](const Hit& hit) { return hit.triangle != NO_TRIANGLE; }));
}

// What rays pass, by the arguments of a stage with alpha; nothing by those of others.
template <class Args>
PassedHits passed_hits(const Args& args) {
  if constexpr (requires { args.alpha_maps; })
    return [&args](std::size_t ray, const Hit& hit) {
      return twins::Alpha(args, args.rays[ray]).lets_through(hit);
    };
  return {};
}

template <class Args>
void trace_closest_on_host(const Args& args, const Bvh& bvh, std::span<const Triangle> triangles,
                           FrameReport& report) {
  const bool bounced = args.count_at.value != 0;
  const std::uint32_t count = bounced ? args.count_at[0] : args.ray_count;
  const std::span<const Ray> rays(&args.rays[0], count);
  const std::span<Hit> hits(&args.hits[0], count);
  trace_all(bvh.nodes, triangles, rays, hits, passed_hits(args));
  (bounced ? report.bounced.rays : report.rays) += rays.size();
  (bounced ? report.bounced.hits : report.hits) += count_hits(hits);
}

// Of shadow or occlusion rays: whether there is a closest hit.
template <class Args>
void trace_any_on_host(const Args& args, const Bvh& bvh, std::span<const Triangle> triangles,
                       TraceCounts& counts) {
  const std::span<const Ray> rays(&args.rays[0], args.count_at[0]);
  std::vector<Hit> hits(rays.size());
  trace_all(bvh.nodes, triangles, rays, hits, passed_hits(args));
  for (std::size_t i = 0; i < hits.size(); ++i) args.any_hits[i] = hits[i].triangle != NO_TRIANGLE;
  counts.rays += rays.size();
  counts.hits += count_hits(hits);
}

// The device's chain, with the independent tracer in the place of its tracer.
struct HostTrace {
  CpuExecutor& executor;
  const FramePlan& plan;
  const Bvh& bvh;
  std::span<const Triangle> triangles;
  FrameReport& report;
  Pace pace;

  void run(const Chain& chain) {
    for (const Step& step : chain.steps()) {
      if (const auto* const closest = args_of(step, stages::trace_closest))
        trace_closest_on_host(*closest, bvh, triangles, report);
      else if (const auto* const past_holes = args_of(step, stages::trace_closest_alpha))
        trace_closest_on_host(*past_holes, bvh, triangles, report);
      else if (const auto* const any = args_of(step, stages::trace_any))
        trace_any_on_host(*any, bvh, triangles, is_occlusion(*any) ? report.occlusion : report.shadow);
      else if (const auto* const any_past_holes = args_of(step, stages::trace_any_alpha))
        trace_any_on_host(*any_past_holes, bvh, triangles,
                          is_occlusion(*any_past_holes) ? report.occlusion : report.shadow);
      else
        executor.run(step);
    }
  }

  template <class Args>
  bool is_occlusion(const Args& args) const {
    const Slot<TraceCounters>& counters = plan.trace.lights.occlusion_counters;
    return counters.count > 0 && executor.chain().at(counters).value == args.counters.value;
  }

  // In pieces, so that Ctrl-C is heard soon. Returns the seconds they took, and calls `after` with the work
  // of each.
  double trace(const TracePlan& trace, const std::function<void(std::uint64_t)>& after = {}) {
    double ms = 0;
    for (TracePieces pieces = plan.pieces(trace); !pieces.done();) {
      throw_if_interrupted();
      Chain chain = executor.chain();
      const auto start = std::chrono::steady_clock::now();
      const std::uint64_t work = pieces.append(chain, pace.work());
      run(chain);
      const double piece_ms =
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
      pace.note(work, piece_ms);
      ms += piece_ms;
      if (after) after(work);
    }
    throw_if_interrupted();
    return ms / 1000;
  }
};

Refined refine_on_host(HostTrace& host, Film& film, const RefineLimits& limits) {
  const TracePlan& trace = host.plan.trace;
  const auto pass = [&](std::uint32_t first, std::uint32_t end) {
    TracePlan some = plan_of_pass(trace, first, end);
    if (is_of_some_pixels(limits, first)) {
      Chain chain = host.executor.chain();
      append_active_pixels(chain, trace.noise, host.plan.tree.state, limits.error);
      host.run(chain);
      some.traced_pixels = {trace.noise.pixels.place, host.executor.read(trace.noise.active_count)[0]};
      if (some.traced_pixels.count == 0) return 0.0;
    }
    return host.trace(some);
  };
  const auto error = [&](std::uint32_t samples) {
    Chain chain = host.executor.chain();
    append_noise_sum(chain, trace.noise, samples);
    host.run(chain);
    return picture_error(host.executor.read(noise_sum_of(trace.noise))[0], trace.image.count);
  };
  const Refined refined = refine(limits, pass, error);
  film.samples = refined.samples;
  host.executor.upload(trace.film, std::span<const Film>(&film, 1));
  Chain pixels = host.executor.chain();
  append_resolved(pixels, trace);
  host.run(pixels);
  return refined;
}

void trace_on_host(CpuExecutor& executor, const FramePlan& plan, const Bvh& bvh,
                   std::span<const Triangle> triangles, const RefineLimits& limits, Film& film,
                   FrameReport& report) {
  constexpr double target_ms = 200;
  const std::uint64_t first_work = bvh.nodes.empty() ? (1u << 20) / (triangles.size() + 1) + 1 : 256;
  HostTrace host{executor, plan, bvh, triangles, report, Pace(target_ms, first_work)};
  const InterruptionGuard guard;
  if (limits.any()) {
    report.refined = refine_on_host(host, film, limits);
    report.trace_ms = 1000 * report.refined->seconds;
    return;
  }
  Progress progress("tracing", 100);
  const std::uint64_t all_work = plan.pieces(plan.trace).work();
  std::uint64_t done_work = 0;
  const double seconds = host.trace(plan.trace, [&](std::uint64_t work) {
    done_work += work;
    progress.advance(static_cast<std::uint32_t>(100 * done_work / all_work));
  });
  report.trace_ms = 1000 * seconds;
}

}  // namespace

FrameReport measure_host_frame(CheckedDevice* device, const Scene& scene, const SceneArrays& arrays,
                               const FrameRuns& frame, const Note& note) {
  FrameReport report;
  report.trace_device = "host CPU";
  report.build = report_for(frame.builder, scene, arrays.triangles, note);
  Bvh bvh;
  if (frame.builder.on_device()) {
    const BuildOptions options = device->build_options(frame.builder.build_options(report.build.morton_bits));
    const BuildRuns runs{.runs = frame.runs, .trace_events = frame.trace_events};
    report.build = measure_device_build(*device, arrays.triangles, options, runs, report.build, &bvh);
  } else {
    report.build = measure_cpu_build(arrays.triangles, report.build, frame.runs, bvh);
  }

  Layout layout(~std::uint64_t{0});
  FrameOptions options{.trace = frame.trace};
  options.trace.show = kernel_view(frame.show.show);
  options.trace.keep_noise = frame.refine.any();
  options.trace.adaptive = frame.refine.adaptive;
  options.trace.walk = Walk::binary;  // in its place traces the CPU tracer, which has the tree
  const FramePlan plan = plan_frame(layout, arrays, options);
  CpuExecutor executor(layout);
  Film film = make_film(scene, frame.camera, frame.trace.width, frame.trace.height, frame.trace.samples);
  film.is_sequence = frame.refine.any();
  upload_frame(executor, plan.tree, plan.trace, arrays, film);
  report.shown.options = frame.show;
  report.shown.scale =
      span_of(frame.show, film, box_of(arrays.triangles), options.trace.walk, arrays.triangle_count());
  upload_show(executor, plan.trace.show, frame.show.show, report.shown.scale);
  if (plan.trace.show.primitive_values.count > 0)
    executor.upload(plan.trace.show.primitive_values,
                    std::span<const uint>(shown_values(frame.show, arrays.triangles, report.build.morton_bits,
                                                       {bvh.nodes, {}})));
  trace_on_host(executor, plan, bvh, arrays.triangles, frame.refine, film, report);
  report.image = executor.read(plan.trace.image);
  if (plan.trace.paths.lobe_counters.count > 0)
    report.lobes = counts_of(executor.read(plan.trace.paths.lobe_counters)[0]);
  if (plan.trace.options.keep_radiance)
    report.radiance = mean_radiance(executor.read(plan.trace.radiance), film.width, film.height, film.samples,
                                    executor.read(plan.trace.noise.sample_counts));
  if (plan.trace.show.range.count > 0)
    report.shown.seen = seen_in(executor.read(plan.trace.show.range)[0], frame.show.show);
  if (frame.show.show == Show::boxes)
    draw_box_lines(report.image, film.width, film.height,
                   box_lines(bvh.nodes, film, frame.show.level, BOXES_SHOWN), frame.show.level);
  return report;
}

}  // namespace coppice
