#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/tree_hash.h"
#include "apps/frame.h"
#include "apps/render_frame.h"
#include "apps/scene_room.h"
#include "pipeline/interruption.h"
#include "scene/write_file.h"
#include "scene/write_png.h"

namespace coppice {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Json effects_of(const Scene& scene) {
  Json effects = Json::array({"ambient"});
  if (scene.light.radiance != vec3(0)) effects.push_back("directional_light");
  return effects;
}

// In the coordinates of the file, as --camera takes them.
Json camera_of(const Scene& scene, const Options& options) {
  const View view = choose_view(scene, options.camera, options.width, options.height);
  return {{"eye", coordinates(to_file(scene, view.eye))},
          {"target", coordinates(to_file(scene, view.target))},
          {"up", coordinates(direction_to_file(scene, -view.down))},
          {"fov", view.vertical_fov_degrees}};
}

Json to_json(const RenderReport& report, const Scene& scene, const Options& options) {
  const double rays = static_cast<double>(report.rays);
  Json json = {{"build", to_json(report.build)},
               {"width", options.width},
               {"height", options.height},
               {"spp", options.samples},
               {"offset", coordinates(scene.offset)},
               {"camera", camera_of(scene, options)},
               {"tracer", options.tracer},
               {"trace_device", report.trace_device},
               {"tree", report.walks_wide ? "wide" : "binary"},
               {"wide_ms", report.wide_ms},
               {"trace_ms", report.trace_ms},
               {"rays",
                {{"primary", report.rays},
                 {"shadow", 0},
                 {"reflection", 0},
                 {"refraction", 0},
                 {"occlusion", 0},
                 {"diffuse", 0}}},
               {"mrays_per_s", rays / report.trace_ms / 1000},
               {"effects", effects_of(scene)},
               {"kernels", to_json(report.kernels)}};
  sums_to_json(report.kernels, json);
  json["image_hash"] = hex16(image_hash(report.image));
  json["hits"] = report.hits;
  json["steps_per_ray"] = rays > 0 ? static_cast<double>(report.steps) / rays : 0.0;
  return json;
}

void print_render(const RenderReport& report, const Options& options, double load_ms, double prepare_ms,
                  double write_ms) {
  const BuildReport& build = report.build;
  std::printf("%s: %llu triangles", build.scene.c_str(), static_cast<unsigned long long>(build.triangles));
  if (build.inactive) std::printf(", %llu of them inactive", static_cast<unsigned long long>(build.inactive));
  std::printf("\n  load     %9.1f ms\n", load_ms);
  if (prepare_ms > 0) std::printf("  device   %9.1f ms  open, self-check\n", prepare_ms);
  std::printf("  build    %9.1f ms  %s on %s", build.build_ms.median, build.builder.c_str(),
              build.device.c_str());
  std::printf(", SAH cost %.2f, depth %u\n", build.quality.sah, build.quality.depth);
  if (report.walks_wide)
    std::printf("  wide     %9.1f ms  the tree with eight children a node\n", report.wide_ms);
  std::printf("  trace    %9.1f ms  %ux%u, %u spp, %.2f Mrays/s on the %s\n", report.trace_ms, options.width,
              options.height, options.samples, static_cast<double>(report.rays) / report.trace_ms / 1000,
              options.tracer.c_str());
  std::printf("  write    %9.1f ms\n", write_ms);
  if (!report.kernels.rows.empty() && !build.kernels.rows.empty()) print_kernels(build.kernels);
  if (!report.kernels.rows.empty()) print_kernels(report.kernels);
  std::printf("picture: %s\n", options.output.c_str());
}

}  // namespace

int run_render(const Options& options) {
  check_writable(options.output);
  const auto load_start = Clock::now();
  const bool on_device = options.tracer == "gpu" || find_device_builder(options.builder);
  const Scene scene = open_scene_with_room(options, on_device);
  const double load_ms = ms_since(load_start);
  print_warnings(scene);

  std::optional<CheckedDevice> device;
  const auto device_start = Clock::now();
  const CommandUse use{find_device_builder(options.builder) != nullptr, options.tracer == "gpu",
                       static_cast<std::uint32_t>(scene.indices.size())};
  if (on_device) device.emplace(open_device(options, use));
  const double device_ms = device ? ms_since(device_start) : 0;
  const bool split = options.kernels || !options.json.empty() || !options.trace_events.empty();
  const RenderReport report =
      options.tracer == "gpu"
          ? render_on_device(*device, scene, options,
                             device->picture_options(trace_options_of(options), use.triangle_count), split)
          : render_on_host(device ? &*device : nullptr, scene, options);
  const InterruptionGuard guard;  // no half-written file
  const auto write_start = Clock::now();
  write_png(options.output, options.width, options.height, report.image);
  if (talks(options)) print_render(report, options, load_ms, device_ms, ms_since(write_start));
  write_json(options.json, to_json(report, scene, options));
  throw_if_interrupted();
  return device ? validation_status(device->device()) : 0;
}

}  // namespace coppice
