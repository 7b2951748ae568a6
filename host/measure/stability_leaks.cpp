#include <algorithm>
#include <limits>

#include "analysis/hard_rays.h"
#include "builders/ploc.h"
#include "measure/progress.h"
#include "measure/stability_runs.h"
#include "measure/steady_state.h"
#include "pipeline/ray_tracing.h"
#include "scene/random.h"
#include "stages/errors.h"

namespace coppice {

namespace {

constexpr std::uint64_t most_rays_at_once = 1u << 20;

TraceOptions variant_options(const CheckedDevice& device, const IntersectionVariant& variant) {
  TraceOptions options = device.trace_options({});
  options.triangle_test = variant.triangle_test;
  options.box_test = variant.box_test;
  return options;
}

// From 16 random points in the middle eighth of the scene's box, which is inside of every closed case.
std::vector<Ray> rays_from_inside(const Node& root, std::span<const Triangle> triangles, std::uint32_t count,
                                  std::uint64_t seed) {
  constexpr std::uint32_t points = 16;
  Random random(seed);
  std::vector<Ray> rays;
  for (std::uint32_t k = 0; k < points; ++k) {
    const vec3 offset = random.in_cube();
    const vec3 point = centre_of(root) + offset * (root.box_max - root.box_min) * 0.0625f;
    const std::uint32_t share = count * (k + 1ull) / points - count * std::uint64_t{k} / points;
    const std::vector<Ray> more = inside_rays(point, triangles, share, seed + k);
    rays.insert(rays.end(), more.begin(), more.end());
  }
  return rays;
}

// A row for each variant; all get the same rays.
std::vector<LeakCount> count_leaks(CheckedDevice& device, const HardCase& hard_case, double scale,
                                   const StabilityOptions& options) {
  const std::uint64_t rays = options.leak_rays;
  const std::vector<Triangle> triangles =
      case_triangles(hard_case, hard_case.default_triangle_count, options.seed, static_cast<float>(scale));
  const Bvh bvh = build_ploc(triangles, {});
  RayTracing tracing(device.device(), bvh.nodes, triangles,
                     static_cast<std::uint32_t>(std::min(rays, most_rays_at_once)));
  std::vector<LeakCount> counts;
  for (const IntersectionVariant& variant : intersection_variants()) {
    counts.push_back({std::string(hard_case.name), scale, &variant});
  }
  for (std::uint64_t first = 0; first < rays; first += most_rays_at_once) {
    const auto count = static_cast<std::uint32_t>(std::min(rays - first, most_rays_at_once));
    const std::vector<Ray> batch = rays_from_inside(bvh.nodes[0], triangles, count, options.seed + first);
    for (LeakCount& leak : counts) {
      const TracedRays traced = tracing.on_device(batch, variant_options(device, *leak.variant));
      if (traced.error_word) throw DeviceError(describe_error_word(traced.error_word));
      leak.rays += count;
      leak.leaks += count - traced.hit_count;
      if (traced.hit_count < count && leak.example.empty()) {
        leak.example = described(example_of_leak({bvh.nodes, triangles, batch, traced.hits}, "from inside"));
      }
      leak.seconds += traced.ms / 1000;
    }
  }
  return counts;
}

}  // namespace

std::vector<LeakCount> count_leaks(CheckedDevice& device, std::span<const HardCase* const> cases,
                                   const StabilityOptions& options) {
  const std::vector<double> scales = {1e-6, 1e-3, 1.0, 1e3, 1e6};
  std::vector<LeakCount> all;
  const auto closed = static_cast<std::uint32_t>(
      std::ranges::count_if(cases, [](const HardCase* one) { return one->closed; }));
  Progress progress("closed meshes", closed * static_cast<std::uint32_t>(scales.size()));
  for (const HardCase* const hard_case : cases) {
    if (!hard_case->closed) continue;
    for (const double scale : scales) {
      const std::vector<LeakCount> counts = count_leaks(device, *hard_case, scale, options);
      all.insert(all.end(), counts.begin(), counts.end());
      progress.step();
    }
  }
  return all;
}

double cost_of_nan_rays(CheckedDevice& device) {
  constexpr std::uint32_t ray_count = 1u << 18;
  const std::vector<Triangle> triangles = case_triangles(*find_hard_case("sphere"), 20000, 1);
  const Bvh bvh = build_ploc(triangles, {});
  RayTracing tracing(device.device(), bvh.nodes, triangles, ray_count);
  const std::vector<Ray> sound = hard_rays(RayKind::RANDOM, triangles, bvh.nodes, ray_count, 1);
  std::vector<Ray> unsound = sound;
  for (std::size_t i = 0; i < unsound.size(); ++i) {
    vec3& part = i % 2 ? unsound[i].origin : unsound[i].direction;
    part[static_cast<int>(i / 2 % 3)] = std::numeric_limits<float>::quiet_NaN();
  }
  const TraceOptions options = variant_options(device, intersection_variants().back());
  std::vector<double> ratios;
  tracing.on_device(sound, options);
  for (int run = 0; run < 5; ++run) {
    ratios.push_back(tracing.on_device(unsound, options).ms / tracing.on_device(sound, options).ms);
  }
  return spread_of(ratios).median;
}

}  // namespace coppice
