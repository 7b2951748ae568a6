#include "measure/traffic.h"

namespace coppice {

RunCounts counts_of_trace(const TraceCounters& counters) {
  const TraceCounts traced = counts_of(counters);
  RunCounts counts;
  counts.rays = traced.rays;
  counts.hits = traced.hits;
  counts.steps = traced.steps;
  return counts;
}

RunCounts counts_of_picture(const GpuExecutor& executor, const TracePlan& plan) {
  RunCounts counts = counts_of_trace(executor.read(plan.counters)[0]);
  const auto secondary = [&](const Slot<TraceCounters>& slot, std::uint64_t lights) {
    if (slot.count == 0) return RunCounts::Secondary{};
    const TraceCounts left = counts_of(executor.read(slot)[0]);
    return RunCounts::Secondary{counts.rays * lights, left.rays, left.hits, left.steps};
  };
  const PathCounts& paths = plan.options.paths;
  const std::uint64_t lights =
      paths.any() ? (paths.bounces + 1) * (paths.fog ? 2 : 1) : plan.options.lights.shadows;
  counts.shadow = secondary(shadow_counters(plan), lights);
  counts.occlusion = secondary(plan.lights.occlusion_counters, 1);
  counts.paths = secondary(plan.paths.bounce_counters, paths.bounces);
  if (plan.paths.lobe_counters.count > 0)
    counts.lobes = counts_of(executor.read(plan.paths.lobe_counters)[0]);
  return counts;
}

std::uint64_t modelled_bytes(const Step& step, const RunCounts& counts) {
  if (const Clear* const clear = std::get_if<Clear>(&step)) return clear->bytes;
  const Dispatch* const dispatch = dispatch_of(step);
  return dispatch ? dispatch->stage->traffic(dispatch->args.data(), counts) : 0;
}

}  // namespace coppice
