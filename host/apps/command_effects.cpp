#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "measure/effects_report.h"
#include "measure/table.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

class EffectsCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    add_picture(app, picture_, scene_.up);
    add_effects(app, scene_);
    add_lens(app, scene_);
    add_tree(app, device_.choices.walk);
    add_runs(app, runs_, "make each picture so many times; the time of all of it is the median");
    add_scene_and_build(app, scene_, builder_, device_, device_builder_names());
  }

  void check(const CLI::App&) override { parse_view(picture_); }

  std::vector<std::string> scenes() const override { return {scene_.spec}; }

  int run() override {
    const Scene scene = open_for_effects(scene_, builder_, device_, true, true);
    const auto triangles = static_cast<std::uint32_t>(scene.indices.size());
    CheckedDevice device = open_device(device_, {.builds = true,
                                                 .build = builder_.least_build_options(),
                                                 .traces = {picture_.trace},
                                                 .triangle_count = triangles});
    FrameRuns frame{.builder = builder_, .trace = device.picture_options(picture_.trace, triangles)};
    frame.camera = picture_.camera;
    frame.runs = runs_;
    frame.effects = scene_.effects;
    const EffectsReport report = measure_effects(device, scene, picture_arrays(scene, frame.effects), frame);
    if (files.talks()) print(text_of(report, frame));
    write_json(files.json, to_json(report, frame));
    return validation_status(device);
  }

 private:
  std::uint32_t runs_ = 1;
  SceneOptions scene_;
  PictureOptions picture_;
  BuilderChoice builder_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_effects() { return std::make_unique<EffectsCommand>(); }

}  // namespace coppice
