#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "apps/open_view.h"
#include "apps/option_rules.h"
#include "measure/table.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

class ViewCommand : public Command {
 public:
  ViewCommand() {
    builder_.name = "gpu-hploc";
    picture_.trace.width = 1280;
    picture_.trace.height = 800;
  }

  void add_options(CLI::App& app) override {
    app.add_option("--frames", run_.frames, "end by itself after so many frames, each a step of the scene")
        ->check(CLI::Range(1u, 1'000'000u));
    app.add_flag("--paused", run_.paused, "a moving scene stands still at first");
    app.add_flag("--rebuild", run_.rebuild, "build the tree anew for every frame");
    add_update(app, run_.update);
    app.add_flag("--no-panes", no_panes_, "without panes at first");
    app.add_option("--pictures", run_.pictures, "what the names of written pictures begin with")
        ->type_name("PREFIX")
        ->capture_default_str();
    add_view(app, picture_, scene_.up);
    app.add_option("--spp", run_.refine.most_samples,
                   "samples per pixel that a picture which stands still is refined to; 1: none")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    add_error(app, run_.refine,
              "or until its relative error, estimated from its samples, is no more than this");
    add_effects(app, scene_);
    add_lens(app, scene_);
    add_tone(app, picture_.trace.tone);
    add_show(app, run_.show);
    add_intersection(app, picture_.trace);
    add_tree(app, device_.choices.walk);
    add_scene_and_build(app, scene_, builder_, device_, builder_names());
  }

  void check(const CLI::App& app) override {
    parse_view(picture_);
    check_options_matter(app, {{"--most-steps", run_.show.show == Show::steps, "--show steps"},
                               {"--round", run_.show.show == Show::clusters, "--show clusters"},
                               {"--level", run_.show.show == Show::boxes, "--show boxes"}});
  }

  std::vector<std::string> scenes() const override { return {scene_.spec}; }

  int run() override {
    run_.scene = scene_;
    run_.builder = builder_;
    run_.device = device_.options;
    run_.device.pipeline_folder = cache_folder();
    run_.choices = device_.choices;
    run_.trace = picture_.trace;
    run_.camera = picture_.camera;
    run_.panes = !no_panes_;
    run_.talks = files.talks();
    const ViewReport report = open_view(run_, print_note);
    write_json(files.json, to_json(report));
    for (const std::string& message : report.validation_messages)
      std::fprintf(stderr, "validation: %s\n", message.c_str());
    return report.validation_messages.empty() ? 0 : 1;
  }

 private:
  bool no_panes_ = false;
  ViewRun run_;
  SceneOptions scene_;
  PictureOptions picture_;
  BuilderChoice builder_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_view() { return std::make_unique<ViewCommand>(); }

}  // namespace coppice
