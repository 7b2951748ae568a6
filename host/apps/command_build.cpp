#include <nlohmann/json.hpp>

#include "apps/frame.h"
#include "apps/measure_build.h"
#include "apps/scene_room.h"

namespace coppice {

namespace {

BuildReport build_on_device(const Options& options, const SceneArrays& arrays, BuildReport report,
                            int& status) {
  CheckedDevice device = open_device(options, {});
  Layout layout(device.properties().max_block_bytes);
  BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(arrays.triangles.size()),
                              device.build_options(build_options_of(options, report.morton_bits)));
  std::optional<WidePlan> wide;
  if (options.wide) wide = plan_wide(layout, plan, &plan);
  GpuExecutor executor(device.device(), layout);
  executor.upload(plan.triangles, std::span<const Triangle>(arrays.triangles));
  for (const std::uint64_t bytes : layout.block_bytes()) report.device_bytes += bytes;
  report = measure_gpu_build(device, executor, plan, report, options, wide ? &*wide : nullptr);
  status = validation_status(device.device());
  return report;
}

}  // namespace

int run_build(const Options& options) {
  const Scene scene = open_scene_with_room(options, find_device_builder(options.builder));
  print_warnings(scene);
  const SceneArrays arrays = scene_arrays(scene);
  BuildReport report = report_for(options, scene, arrays.triangles);
  int status = 0;
  Bvh bvh;
  report = find_device_builder(options.builder)
               ? build_on_device(options, arrays, report, status)
               : measure_cpu_build(arrays.triangles, report, options.runs, bvh);
  if (talks(options)) print_build(report);
  write_json(options.json, to_json(report));
  return status;
}

}  // namespace coppice
