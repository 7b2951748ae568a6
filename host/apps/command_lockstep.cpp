#include <cstdio>

#include "analysis/compare.h"
#include "apps/checked_device.h"
#include "apps/frame.h"
#include "apps/measure_build.h"
#include "apps/report.h"
#include "apps/scene_room.h"
#include "pipeline/wide.h"
#include "stages/errors.h"
#include "stages/lockstep_executor.h"

namespace coppice {

namespace {

Json to_json(const std::optional<Difference>& difference) {
  if (!difference) return nullptr;
  return {{"stage", difference->stage},
          {"slot", difference->slot},
          {"index", difference->index},
          {"cpu", difference->cpu},
          {"gpu", difference->gpu}};
}

// A division or a square root may differ by an ulp between a GPU and the host: there the trace is compared by
// its hits.
struct HitTolerance {
  HitDifference worst{};
  std::uint32_t stages = 0;

  LockstepExecutor::Tolerate judge(const LockstepExecutor& executor, const TracePlan& plan) {
    return [this, &executor, &plan](const Difference& difference) {
      if (difference.stage != "trace_closest" && difference.stage != "trace_wide" &&
          difference.stage != "trace_wide_single" && difference.stage != "trace_brute_force" &&
          difference.stage != "shade" && difference.stage != "resolve" && difference.stage != "camera_rays") {
        return false;
      }
      ++stages;
      const HitDifference found =
          compare_hits(executor.cpu().read(plan.hits), executor.gpu().read(plan.hits));
      worst.count = std::max(worst.count, found.count);
      worst.other_triangle = std::max(worst.other_triangle, found.other_triangle);
      worst.largest_relative_t = std::max(worst.largest_relative_t, found.largest_relative_t);
      return true;
    };
  }
};

}  // namespace

int run_lockstep(const Options& options) {
  const Scene scene = open_scene_with_room(options, true);
  print_warnings(scene);
  const SceneArrays arrays = scene_arrays(scene);
  CheckedDevice device = open_device(options);
  Layout layout(device.device.properties().max_block_bytes);
  BuildPlan build = plan_build(layout, static_cast<std::uint32_t>(arrays.triangles.size()),
                               device.build_options(options, morton_bits_for(options, arrays.triangles)));
  TraceOptions trace_options = device.trace_options(options);
  trace_options.wide = device.walks_wide(options, build.triangle_count);
  std::optional<WidePlan> wide;
  if (trace_options.wide) wide = plan_wide(layout, build, &build);
  const TracePlan trace =
      plan_trace(layout, build, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  LockstepExecutor executor(device.device, layout);
  upload_frame(executor, build, trace, arrays,
               make_film(scene, options.camera, options.width, options.height, options.samples));

  HitTolerance tolerance;
  const bool exact_trace = device.device.properties().type == DeviceType::cpu;
  const auto difference = executor.run(
      [&](Chain& chain) {
        append_build(chain, build);
        if (wide) append_wide(chain, build, *wide);
        append_trace(chain, build, trace);
      },
      exact_trace ? LockstepExecutor::Tolerate() : tolerance.judge(executor, trace));
  const BuildState state = executor.cpu().read(build.state)[0];
  const std::string error = describe_error_word(state.error_word);

  if (talks(options)) {
    std::printf("%s: %zu triangles, %u rounds of at most %u, %u stages run on %s and by their twins\n",
                scene.name.c_str(), arrays.triangles.size(), state.round_count, build.rounds_bound,
                executor.stages_run(), device.device.properties().name.c_str());
    if (tolerance.stages) {
      std::printf("trace: %llu of %llu hits differ, %llu in the triangle; relative distance at most %g\n",
                  static_cast<unsigned long long>(tolerance.worst.count),
                  static_cast<unsigned long long>(trace.hits.count),
                  static_cast<unsigned long long>(tolerance.worst.other_triangle),
                  tolerance.worst.largest_relative_t);
    }
    if (difference) {
      std::printf("first difference: stage %s, slot %s, index %llu\n  cpu %s\n  gpu %s\n",
                  difference->stage.c_str(), difference->slot.c_str(),
                  static_cast<unsigned long long>(difference->index), difference->cpu.c_str(),
                  difference->gpu.c_str());
    } else {
      std::printf("no difference\n");
    }
  }
  Json json = {
      {"stages", executor.stages_run()}, {"equal", !difference}, {"first_difference", to_json(difference)}};
  if (tolerance.stages) {
    json["hits_differing"] = tolerance.worst.count;
    json["hits_on_other_triangle"] = tolerance.worst.other_triangle;
    json["largest_relative_t"] = tolerance.worst.largest_relative_t;
  }
  write_json(options.json, json);
  if (!error.empty()) throw DeviceError(error);
  const int validation = validation_status(device.device);
  if (difference) {
    std::fprintf(stderr, "coppice: stage %s differs at %s[%llu]\n", difference->stage.c_str(),
                 difference->slot.c_str(), static_cast<unsigned long long>(difference->index));
  }
  return difference ? 1 : validation;
}

}  // namespace coppice
