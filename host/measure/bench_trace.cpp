#include <algorithm>

#include "analysis/compare.h"
#include "analysis/cpu_tracer.h"
#include "builders/registry.h"
#include "measure/bench.h"
#include "measure/measure_frame.h"
#include "pipeline/ray_tracing.h"
#include "render/frame.h"
#include "render/scene_room.h"
#include "scene/random.h"
#include "scene/scene_source.h"
#include "stages/errors.h"

namespace coppice {

namespace {

constexpr std::size_t checked_rays = 20000;

// The first rays, against the twins. A GPU may round a division otherwise, so there a few triangles may
// differ.
void check_hits(RayTracing& tracing, std::span<const Ray> rays, const TraceOptions& trace, bool exact) {
  const auto some = rays.first(std::min(rays.size(), checked_rays));
  const TracedRays device = tracing.on_device(some, trace), host = tracing.by_twins(some, trace);
  if (device.error_word) throw DeviceError(describe_error_word(device.error_word));
  const HitDifference difference = compare_hits(host.hits, device.hits);
  if (exact ? difference.count > 0 : difference.other_triangle > some.size() / 1000)
    throw DeviceError("trace: " + std::to_string(difference.count) + " of " + std::to_string(some.size()) +
                      " hits are not the twin's");
}

// All rays, against the tracer of the CPU, which computes in double: at an edge either may see what the other
// does not. How many are not as there.
std::size_t check_any_hits(RayTracing& tracing, std::span<const Node> nodes,
                           std::span<const Triangle> triangles, std::span<const Ray> rays,
                           const TraceOptions& trace) {
  const TracedAnyHits device = tracing.any_on_device(rays, trace);
  if (device.error_word) throw DeviceError(describe_error_word(device.error_word));
  std::vector<Hit> closest(rays.size());
  trace_all(nodes, triangles, rays, closest);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    wrong += (device.any_hits[i] != 0) != (closest[i].triangle != NO_TRIANGLE);
  if (wrong > rays.size() / 10000)
    throw DeviceError("trace: " + std::to_string(wrong) + " of " + std::to_string(rays.size()) +
                      " any hits are not those of the CPU");
  return wrong;
}

TraceOptions trace_options(const CheckedDevice& device, const BenchOptions& options, Walk walk) {
  TraceOptions trace = device.trace_options(options.trace);
  trace.walk = walk;
  return trace;
}

// The whole chain of a picture of the same rays: camera rays, closest hits, shading, sRGB.
void add_frame(CheckedDevice& device, const BenchOptions& options, const Scene& scene, Walk walk,
               BenchRow& row) {
  const FrameReport frame =
      measure_frame(device, scene, scene_arrays(scene, effects_of(scene, EffectChanges(no_effects()))),
                    {.builder = options.builder,
                     .trace = trace_options(device, options, walk),
                     .camera = options.camera,
                     .runs = options.runs,
                     .effects = EffectChanges(no_effects())});
  if (frame.rays != row.size) throw DeviceError("the picture has other rays than the measurement");
  const double mrays_per_s = static_cast<double>(frame.rays) / frame.trace_ms / 1000;
  row.figures = {{"frame_ms", frame.trace_ms}, {"frame_millions_per_s", mrays_per_s}};
  row.note = format("whole picture %.3f ms, %.2f millions/s", frame.trace_ms, mrays_per_s);
}

// The primary rays of a scene, and the trees of one builder that rays are traced through.
class TraceBench {
 public:
  TraceBench(CheckedDevice& device, const BenchOptions& options, const Scene& scene)
      : device_(device),
        options_(options),
        scene_(scene),
        arrays_(scene_arrays(scene)),
        has_wide_(can_trace_wide(options.trace)),
        primary_(
            rays_through(make_film(scene, options.camera, options.trace.width, options.trace.height, 1))),
        bvh_(built(options.builder, arrays_.triangles)),
        tracing_(device.device(), bvh_.nodes, arrays_.triangles, static_cast<std::uint32_t>(primary_.size()),
                 has_wide_) {}

  std::vector<Walk> walks() const {
    return has_wide_ ? std::vector{Walk::binary, Walk::wide_packets, Walk::wide_single}
                     : std::vector{Walk::binary};
  }

  const std::vector<Ray>& primary() const { return primary_; }

  // One from each hit of the primary rays.
  std::vector<Ray> diffuse() {
    std::vector<Ray> rays = tracing_.bounce(primary_, device_.trace_options(options_.trace), 1);
    std::erase_if(rays, [](const Ray& ray) { return ray.direction == vec3(0); });  // of rays that hit nothing
    return rays;
  }

  // From where each of these rays begins to where another one does, by random.
  std::vector<Ray> shadow(std::span<const Ray> diffuse) const {
    Random random(1);
    std::vector<Ray> rays(diffuse.begin(), diffuse.end());
    for (Ray& ray : rays) {
      ray.direction = diffuse[random.below(static_cast<std::uint32_t>(diffuse.size()))].origin - ray.origin;
      ray.t_max = 0.999f;
    }
    return rays;
  }

  std::string input(Walk walk) const {
    return scene_.name + " " + options_.builder.name + " " + std::string(name_of(walk));
  }

  BenchRow measure(const std::string& name, std::span<const Ray> rays, Walk walk) {
    const TraceOptions trace = trace_options(device_, options_, walk);
    check_hits(tracing_, rays, trace, device_.properties().type == DeviceType::cpu);
    const auto run = [&] {
      const TracedRays traced = tracing_.on_device(rays, trace);
      if (traced.error_word) throw DeviceError(describe_error_word(traced.error_word));
      return traced.ms;
    };
    return bench_row(name, input(walk), rays.size(), measure_steady(steady_options(options_, run()), run));
  }

  BenchRow measure_any(const std::string& name, std::span<const Ray> rays, Walk walk) {
    const TraceOptions trace = trace_options(device_, options_, walk);
    const std::size_t others = check_any_hits(tracing_, bvh_.nodes, arrays_.triangles, rays, trace);
    const auto run = [&] { return tracing_.any_on_device(rays, trace).ms; };
    BenchRow row =
        bench_row(name, input(walk), rays.size(), measure_steady(steady_options(options_, run()), run));
    row.figures = {{"not_as_on_cpu", static_cast<double>(others)}};
    row.note = std::to_string(others) + " of " + std::to_string(rays.size()) + " not as on the CPU";
    return row;
  }

 private:
  static Bvh built(const BuilderChoice& builder, std::span<const Triangle> triangles) {
    return find_cpu_builder(builder.on_device()->cpu_builder)
        .build(triangles, {builder.radius, builder.bits_for(triangles)});
  }

  CheckedDevice& device_;
  const BenchOptions& options_;
  const Scene& scene_;
  SceneArrays arrays_;
  bool has_wide_;
  std::vector<Ray> primary_;
  Bvh bvh_;
  RayTracing tracing_;
};

void bench_trees(CheckedDevice& device, const BenchOptions& options, const Scene& scene, const AddRow& add) {
  TraceBench bench(device, options, scene);
  const std::vector<Ray> diffuse = bench.diffuse();
  for (const Walk walk : bench.walks()) {
    if (is_wanted(options, "trace_primary", bench.input(walk))) {
      BenchRow row = bench.measure("trace_primary", bench.primary(), walk);
      add_frame(device, options, scene, walk, row);
      add(row);
    }
    if (!diffuse.empty() && is_wanted(options, "trace_diffuse", bench.input(walk)))
      add(bench.measure("trace_diffuse", diffuse, walk));
    if (diffuse.empty() || walk == Walk::wide_packets) continue;  // packets have no any hits
    const std::vector<Ray> shadow = bench.shadow(diffuse);
    if (is_wanted(options, "trace_shadow_closest", bench.input(walk)))
      add(bench.measure("trace_shadow_closest", shadow, walk));
    if (is_wanted(options, "trace_shadow_any", bench.input(walk)))
      add(bench.measure_any("trace_shadow_any", shadow, walk));
  }
}

}  // namespace

void bench_trace(CheckedDevice& device, const BenchOptions& options, const AddRow& add) {
  static const std::vector<std::string> default_scenes = {"grove", "hard:detail-on-ground"};
  BenchOptions one = options;
  for (const std::string& name : options.scenes.empty() ? default_scenes : options.scenes) {
    check_room(name, {&device.device(), one.builder.least_build_options()}, device.notes());
    const Scene scene = open_scene(name, options.up);
    for (const std::string& builder :
         options.builders.empty() ? std::vector{options.builder.name} : options.builders) {
      one.builder.name = builder;
      bench_trees(device, one, scene, add);
    }
  }
}

BenchRow bench_primary_rays(CheckedDevice& device, const BenchOptions& options,
                            const SceneOptions& scene_options, Walk walk) {
  const Scene scene = open_scene(scene_options.spec, scene_options.up);
  TraceBench bench(device, options, scene);
  return bench.measure("trace_primary", bench.primary(), walk);
}

}  // namespace coppice
