#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/frame.h"
#include "apps/measure_build.h"
#include "apps/open_device.h"
#include "apps/report.h"
#include "apps/scene_room.h"
#include "pipeline/wide.h"
#include "stages/errors.h"
#include "stages/lockstep_executor.h"

namespace coppice {

namespace {

using Count = unsigned long long;

Json to_json(const std::optional<Difference>& difference) {
  if (!difference) return nullptr;
  return {{"stage", difference->stage}, {"slot", difference->slot}, {"index", difference->index},
          {"cpu", difference->cpu},     {"gpu", difference->gpu},   {"why", difference->why}};
}

// What a GPU left nearly equal: a line, or an entry, for each stage and slot.
void print_nearly(std::span<const NearlyListing> listings) {
  for (const NearlyListing& one : listings) {
    const NearlyEqual& sum = one.sum;
    std::printf("%s, %s: %llu of %llu differ, %llu by more than the tolerance (%llu may)", one.stage,
                one.slot, static_cast<Count>(sum.differing), static_cast<Count>(sum.count),
                static_cast<Count>(sum.beyond), static_cast<Count>(sum.beyond_allowed));
    if (sum.tied) {
      std::printf(", %llu in the triangle at the same distance (%llu may)", static_cast<Count>(sum.tied),
                  static_cast<Count>(sum.tied_allowed));
    }
    std::printf("\n");
  }
}

void add_nearly(Json& json, std::span<const NearlyListing> listings) {
  if (listings.empty()) return;
  NearlyEqual hits;
  json["nearly"] = Json::array();
  for (const NearlyListing& one : listings) {
    json["nearly"].push_back({{"stage", one.stage},
                              {"slot", one.slot},
                              {"compared", one.sum.count},
                              {"differing", one.sum.differing},
                              {"beyond", one.sum.beyond},
                              {"beyond_allowed", one.sum.beyond_allowed}});
    if (one.slot == std::string_view("hits")) hits = one.sum;
  }
  json["hits_differing"] = hits.differing;
  json["hits_on_other_triangle"] = hits.tied;
  json["largest_relative_t"] = hits.largest_relative_t;
}

}  // namespace

int run_lockstep(const Options& options) {
  const Scene scene = open_scene_with_room(options, true);
  print_warnings(scene);
  const SceneArrays arrays = scene_arrays(scene);
  CheckedDevice device =
      open_device(options, {true, true, static_cast<std::uint32_t>(arrays.triangles.size())});
  Layout layout(device.properties().max_block_bytes);
  BuildPlan build =
      plan_build(layout, static_cast<std::uint32_t>(arrays.triangles.size()),
                 device.build_options(build_options_of(options, morton_bits_for(options, arrays.triangles))));
  const TraceOptions trace_options = device.picture_options(trace_options_of(options), build.triangle_count);
  std::optional<WidePlan> wide;
  if (is_wide(trace_options.walk)) wide = plan_wide(layout, build, &build);
  const TracePlan trace =
      plan_trace(layout, build, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  LockstepExecutor executor(device.device(), layout);
  upload_frame(executor, build, trace, arrays,
               make_film(scene, options.camera, options.width, options.height, options.samples));

  const auto difference = executor.run([&](Chain& chain) {
    append_build(chain, build);
    if (wide) append_wide(chain, build, *wide);
    append_trace(chain, build, trace);
  });
  const BuildState state = executor.cpu().read(build.state)[0];
  const std::string error = describe_error_word(state.error_word);

  if (talks(options)) {
    std::printf("%s: %zu triangles, %u rounds of at most %u, %u stages run on %s and by their twins\n",
                scene.name.c_str(), arrays.triangles.size(), state.round_count, build.rounds_bound,
                executor.stages_run(), device.properties().name.c_str());
    print_nearly(executor.nearly());
    if (difference) {
      std::printf("first difference: stage %s, slot %s, index %llu\n  cpu %s\n  gpu %s\n%s",
                  difference->stage.c_str(), difference->slot.c_str(),
                  static_cast<unsigned long long>(difference->index), difference->cpu.c_str(),
                  difference->gpu.c_str(),
                  difference->why.empty() ? "" : ("  " + difference->why + "\n").c_str());
    } else {
      std::printf("no difference\n");
    }
  }
  Json json = {
      {"stages", executor.stages_run()}, {"equal", !difference}, {"first_difference", to_json(difference)}};
  add_nearly(json, executor.nearly());
  write_json(options.json, json);
  if (!error.empty()) throw DeviceError(error);
  const int validation = validation_status(device.device());
  if (difference) {
    std::fprintf(stderr, "coppice: stage %s differs at %s[%llu]\n", difference->stage.c_str(),
                 difference->slot.c_str(), static_cast<unsigned long long>(difference->index));
  }
  return difference ? 1 : validation;
}

}  // namespace coppice
