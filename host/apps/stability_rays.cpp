#include <algorithm>

#include "analysis/hard_rays.h"
#include "apps/ray_tracing.h"
#include "apps/report.h"
#include "apps/stability.h"
#include "builders/ploc.h"

namespace coppice {

std::vector<LeakCount> count_leaks(CheckedDevice& device, std::uint64_t rays, const Options& options,
                                   const StabilityOptions& stability) {
  constexpr std::uint64_t most_rays_at_once = 1u << 20;
  std::vector<LeakCount> counts;
  for (const HardCase& hard_case : hard_cases()) {
    if (!hard_case.closed) continue;
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
      const std::vector<Triangle> triangles = case_triangles(hard_case, hard_case.default_triangle_count,
                                                             stability.seed, static_cast<float>(scale));
      const Bvh bvh = build_ploc(triangles, {});
      RayTracing tracing(device, bvh.nodes, triangles,
                         static_cast<std::uint32_t>(std::min(rays, most_rays_at_once)));
      std::vector<LeakCount> row;
      for (const IntersectionVariant& variant : intersection_variants()) {
        row.push_back({std::string(hard_case.name), scale, &variant});
      }
      for (std::uint64_t first = 0; first < rays; first += most_rays_at_once) {
        const auto count = static_cast<std::uint32_t>(std::min(rays - first, most_rays_at_once));
        const std::vector<Ray> batch =
            inside_rays(centre_of(bvh.nodes[0]), triangles, count, stability.seed + first);
        for (LeakCount& leak : row) {
          TraceOptions trace_options = device.trace_options(options);
          trace_options.brute_force = false;
          trace_options.triangle_test = leak.variant->triangle_test;
          trace_options.box_test = leak.variant->box_test;
          const TracedRays traced = tracing.on_device(batch, trace_options);
          if (!traced.error.empty()) throw DeviceError(traced.error);
          leak.rays += count;
          leak.leaks += count - traced.hit_count;
          leak.seconds += traced.ms / 1000;
        }
      }
      counts.insert(counts.end(), row.begin(), row.end());
    }
  }
  return counts;
}

double cost_of_nan_rays(CheckedDevice& device, const Options& options) {
  constexpr std::uint32_t ray_count = 1u << 18;
  const std::vector<Triangle> triangles = case_triangles(*find_hard_case("sphere"), 20000, 1);
  const Bvh bvh = build_ploc(triangles, {});
  RayTracing tracing(device, bvh.nodes, triangles, ray_count);
  const std::vector<Ray> sound = hard_rays(RayKind::RANDOM, triangles, bvh.nodes, ray_count, 1);
  std::vector<Ray> unsound = sound;
  for (std::size_t i = 0; i < unsound.size(); ++i) {
    vec3& part = i % 2 ? unsound[i].origin : unsound[i].direction;
    part[static_cast<int>(i / 2 % 3)] = std::numeric_limits<float>::quiet_NaN();
  }
  TraceOptions trace_options = device.trace_options(options);
  trace_options.brute_force = false;
  std::vector<double> ratios;
  tracing.on_device(sound, trace_options);
  for (int run = 0; run < 5; ++run) {
    ratios.push_back(tracing.on_device(unsound, trace_options).ms /
                     tracing.on_device(sound, trace_options).ms);
  }
  return spread_of(ratios).median;
}

}  // namespace coppice
