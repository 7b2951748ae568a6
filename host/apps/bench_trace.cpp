#include <algorithm>
#include <cstdio>

#include "analysis/compare.h"
#include "apps/bench.h"
#include "apps/frame.h"
#include "apps/measure_build.h"
#include "apps/render_frame.h"
#include "builders/registry.h"
#include "pipeline/ray_tracing.h"
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

// The whole chain of a picture of the same rays: camera rays, closest hits, shading, sRGB.
void add_frame(CheckedDevice& device, Options options, const Scene& scene, BenchRow& row) {
  options.frames = options.runs;
  const RenderReport frame = render_on_device(device, scene, options);
  if (frame.rays != row.size) throw DeviceError("the picture has other rays than the measurement");
  const double mrays_per_s = static_cast<double>(frame.rays) / frame.trace_ms / 1000;
  row.figures = {{"frame_ms", frame.trace_ms}, {"frame_millions_per_s", mrays_per_s}};
  char note[80];
  std::snprintf(note, sizeof note, "whole picture %.3f ms, %.2f millions/s", frame.trace_ms, mrays_per_s);
  row.note = note;
}

// Rays of a scene, and the trees of one builder that they are traced through.
struct TraceBench {
  CheckedDevice& device;
  const Options& options;
  const Scene& scene;
  RayTracing& tracing;

  // `tree` as --tree has it.
  void measure(const std::string& name, std::span<const Ray> rays, const std::string& tree,
               const AddRow& add) const {
    const std::string input = scene.name + " " + options.builder + " " + tree;
    if (rays.empty() || !is_wanted(options, name, input)) return;
    Options frame = options;
    frame.tree = tree;
    TraceOptions trace = device.trace_options(frame);
    trace.wide = tree != "binary";
    check_hits(tracing, rays, trace, device.device.properties().type == DeviceType::cpu);
    const auto run = [&] {
      const TracedRays traced = tracing.on_device(rays, trace);
      if (traced.error_word) throw DeviceError(describe_error_word(traced.error_word));
      return traced.ms;
    };
    BenchRow row = bench_row(name, input, rays.size(), measure_steady(steady_options(options, run()), run));
    if (name == "trace_primary") add_frame(device, frame, scene, row);
    add(row);
  }
};

void bench_trees(CheckedDevice& device, const Options& options, const Scene& scene, const SceneArrays& arrays,
                 const AddRow& add) {
  const Bvh bvh = find_cpu_builder(find_device_builder(options.builder)->cpu_builder)
                      .build(arrays.triangles, {options.radius, morton_bits_for(options, arrays.triangles)});
  const TraceOptions trace = device.trace_options(options);
  const bool has_wide = trace.triangle_test == TRIANGLE_WATERTIGHT && trace.box_test == BOX_ROBUST;
  const std::vector<Ray> primary =
      rays_through(make_film(scene, options.camera, options.width, options.height, 1));
  RayTracing tracing(device.device, bvh.nodes, arrays.triangles, static_cast<std::uint32_t>(primary.size()),
                     has_wide);
  std::vector<Ray> bounced = tracing.bounce(primary, trace, 1);
  std::erase_if(bounced,
                [](const Ray& ray) { return ray.direction == vec3(0); });  // of rays that hit nothing
  const TraceBench bench{device, options, scene, tracing};
  for (const char* tree : {"binary", "wide-packets", "wide-single"}) {
    if (std::string(tree) != "binary" && !has_wide) continue;
    bench.measure("trace_primary", primary, tree, add);
    bench.measure("trace_diffuse", bounced, tree, add);
  }
}

}  // namespace

void bench_trace(CheckedDevice& device, const Options& options, const AddRow& add) {
  const Scene scene = open_scene(options.scene);
  const SceneArrays arrays = scene_arrays(scene);
  Options one = options;
  for (const std::string& builder :
       options.builders.empty() ? std::vector{options.builder} : options.builders) {
    one.builder = builder;
    bench_trees(device, one, scene, arrays, add);
  }
}

}  // namespace coppice
