#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "apps/option_rules.h"
#include "measure/measure_build.h"
#include "measure/table.h"
#include "render/scene_arrays.h"

namespace coppice {

namespace {

class BuildCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    add_runs(app, runs_.runs, "after a warm-up");
    app.add_flag("--rounds", runs_.rounds, "a table of the rounds of gpu-ploc");
    app.add_flag("--wide", runs_.wide, "then convert the tree to wide nodes on the device");
    add_leaf_size(app, builder_);
    add_trace_events(app, files.trace_events);
    add_scene_and_build(app, scene_, builder_, device_, builder_names());
  }

  void check(const CLI::App& app) override {
    const bool builds = builder_.on_device();
    const bool has_rounds = builds && builder_.on_device()->builder == DeviceBuilder::ploc;
    check_options_matter(app, {{"--trace-events", builds, NEEDS_DEVICE_BUILDER},
                               {"--validate", builds, NEEDS_DEVICE_BUILDER},
                               {"--variants", builds, NEEDS_DEVICE_BUILDER},
                               {"--lookback", builds, NEEDS_DEVICE_BUILDER},
                               {"--wide", builds, NEEDS_DEVICE_BUILDER},
                               {"--rounds", has_rounds, "a builder with rounds on the device, gpu-ploc"}});
  }

  std::vector<std::string> scenes() const override { return {scene_.spec}; }

  int run() override {
    const Scene scene = open_scene_of(scene_, builder_, device_, builder_.on_device());
    const SceneArrays arrays = scene_arrays(scene);
    BuildReport report = report_for(builder_, scene, arrays.triangles, print_note);
    int status = 0;
    if (builder_.on_device()) {
      CheckedDevice device = open_device(device_, builder_);
      const BuildOptions options = device.build_options(builder_.build_options(report.morton_bits));
      runs_.trace_events = files.trace_events;
      report = measure_device_build(device, arrays.triangles, options, runs_, report);
      status = validation_status(device);
    } else {
      Bvh bvh;
      report = measure_cpu_build(arrays.triangles, report, runs_.runs, bvh);
    }
    if (files.talks()) print(text_of(report));
    write_json(files.json, to_json(report));
    return status;
  }

 private:
  BuildRuns runs_;
  SceneOptions scene_;
  BuilderChoice builder_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_build() { return std::make_unique<BuildCommand>(); }

}  // namespace coppice
