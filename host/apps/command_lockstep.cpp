#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "measure/lockstep_report.h"
#include "measure/table.h"
#include "render/frame.h"
#include "scene/texture.h"
#include "stages/errors.h"

namespace coppice {

namespace {

class LockstepCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    add_picture(app, picture_, scene_.up);
    add_effects(app, scene_);
    add_lens(app, scene_);
    add_tone(app, picture_.trace.tone);
    add_intersection(app, picture_.trace);
    add_tree(app, device_.choices.walk);
    add_scene_and_build(app, scene_, builder_, device_, device_builder_names());
  }

  void check(const CLI::App&) override { parse_view(picture_); }

  std::vector<std::string> scenes() const override { return {scene_.spec}; }

  int run() override {
    Scene scene = open_scene_of(scene_, builder_, device_, true);
    if (!scene_.effects.turns_off(Effect::alpha)) find_cut_outs(scene);
    const SceneArrays arrays = picture_arrays(scene, scene_.effects);
    const TraceOptions& trace = picture_.trace;
    const BuildOptions least = builder_.least_build_options();
    CheckedDevice device = open_device(device_, {true, least, {trace}, arrays.triangle_count()});
    Layout layout(device.properties().max_block_bytes);
    const FramePlan plan =
        plan_frame(layout, arrays,
                   {.build = device.build_options(builder_.build_options(arrays.triangles)),
                    .trace = device.picture_options(trace, arrays.triangle_count())});
    LockstepExecutor executor(device.device(), layout);
    upload_frame(executor, plan.tree, plan.trace, arrays,
                 make_film(scene, picture_.camera, trace.width, trace.height, trace.samples));
    const LockstepReport report =
        lockstep_report(executor, executor.run([&](Chain& chain) { append_frame(chain, plan); }), plan);

    if (files.talks()) print(text_of(report, scene.name, device.properties().name));
    write_json(files.json, to_json(report));
    const std::string error = describe_error_word(report.state.error_word);
    if (!error.empty()) throw DeviceError(error);
    const int validation = validation_status(device);
    if (!report.difference) return validation;
    std::fprintf(stderr, "coppice: stage %s differs at %s[%llu]\n", report.difference->stage.c_str(),
                 report.difference->slot.c_str(), static_cast<unsigned long long>(report.difference->index));
    return 1;
  }

 private:
  SceneOptions scene_;
  PictureOptions picture_;
  BuilderChoice builder_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_lockstep() { return std::make_unique<LockstepCommand>(); }

}  // namespace coppice
