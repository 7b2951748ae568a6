#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command.h"
#include "apps/open_device.h"
#include "apps/option_rules.h"
#include "measure/effects_report.h"
#include "measure/frame_report.h"
#include "measure/table.h"
#include "pipeline/interruption.h"
#include "scene/input_error.h"
#include "scene/write_exr.h"
#include "scene/write_file.h"
#include "scene/write_png.h"

namespace coppice {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class RenderCommand : public Command {
 public:
  RenderCommand() { files.picture = "coppice.png"; }

  void add_options(CLI::App& app) override {
    app.add_option("-o,--output", files.picture, "the picture: .png, or .exr for linear radiance")
        ->capture_default_str();
    app.add_option("--tracer", tracer_)->check(CLI::IsMember({"gpu", "cpu"}))->capture_default_str();
    app.add_flag("--kernels", kernels_, "print the time of every kernel; takes the frame once more");
    add_picture(app, picture_, scene_.up);
    add_effects(app, scene_);
    add_lens(app, scene_);
    add_tone(app, picture_.trace.tone);
    app.add_flag("--explain", explain_, "say of each effect whether it is on, and what called for it");
    add_refine(app, refine_);
    add_show(app, show_);
    add_intersection(app, picture_.trace);
    add_tree(app, device_.choices.walk);
    add_runs(app, runs_, "build and trace so many times; times are medians");
    add_leaf_size(app, builder_);
    add_trace_events(app, files.trace_events);
    add_scene_and_build(app, scene_, builder_, device_, builder_names());
  }

  void check(const CLI::App& app) override {
    parse_view(picture_);
    if (app.get_option("--spp")->count() > 0) refine_.most_samples = picture_.trace.samples;
    const bool builds = builder_.on_device(), traces = traces_on_device(), either = builds || traces;
    check_show(app);
    picture_.trace.keep_radiance = is_exr(files.picture);
    check_options_matter(app, {{"--trace-events", either, NEEDS_DEVICE},
                               {"--validate", either, NEEDS_DEVICE},
                               {"--adaptive", refine_.error > 0, "--error"},
                               {"--runs", !refine_.any(), "a picture of as many samples as --spp says"},
                               {"--variants", either, NEEDS_DEVICE},
                               {"--lookback", builds, NEEDS_DEVICE_BUILDER},
                               {"--kernels", traces, NEEDS_DEVICE_TRACER},
                               {"--tree", traces, NEEDS_DEVICE_TRACER},
                               {"--triangle-test", traces, NEEDS_DEVICE_TRACER},
                               {"--box-test", traces, NEEDS_DEVICE_TRACER}});
  }

  // A view needs what it shows.
  void check_show(const CLI::App& app) const {
    const Show show = show_.show;
    const auto need = [&](bool has, const char* what) {
      if (!has) throw CLI::ValidationError("--show " + std::string(name_of(show)) + " needs " + what);
    };
    need(show != Show::steps || traces_on_device(), "--tracer gpu, which counts the steps of each ray");
    need(show != Show::steps || builder_.name != "none", "a builder: without a tree no nodes are visited");
    need(show != Show::boxes || builder_.name != "none", "a builder: without a tree there are no boxes");
    need(show != Show::clusters || (builder_.name == "gpu-ploc" && traces_on_device()),
         "--builder gpu-ploc and --tracer gpu");
    need(show != Show::instances || traces_instances(),
         "--tracer gpu, a builder on the device and a binary tree");
    need(show == Show::color || !is_exr(files.picture), "a PNG: radiance, which an EXR holds, is of colours");
    const bool maps = show == Show::color && !is_exr(files.picture);
    constexpr const char* needs_pixels = "--show color and a PNG: an EXR holds radiance as it is";
    check_options_matter(app, {{"--tonemap", maps, needs_pixels}, {"--exposure", maps, needs_pixels}});
    check_options_matter(app, {{"--most-steps", show == Show::steps, "--show steps"},
                               {"--round", show == Show::clusters, "--show clusters"},
                               {"--level", show == Show::boxes, "--show boxes"}});
  }

  std::vector<std::string> scenes() const override { return {scene_.spec}; }

  int run() override {
    check_writable(files.picture);
    FrameSurroundings around{.tracer = tracer_, .output = files.picture};
    const auto load_start = Clock::now();
    const bool on_device = traces_on_device() || builder_.on_device();
    scene_.keep_instances = traces_instances();
    const Scene scene = open_for_effects(scene_, builder_, device_, on_device, true);
    const EffectSet effects = effects_of(scene, scene_.effects);
    if (explain_ && files.talks()) print(explain(effects));
    check_tree(effects);
    around.load_ms = ms_since(load_start);
    if (show_.show == Show::instances && scene.instances.empty())
      throw InputError("--show instances: scene '" + scene.name + "' has no instances");

    if (builder_.name == "none") picture_.trace.walk = Walk::brute_force;
    FrameRuns frame{builder_, picture_.trace, picture_.camera, runs_, false, files.trace_events, show_};
    frame.effects = scene_.effects;
    frame.refine = refine_;
    if (refine_.any()) frame.trace.samples = refine_.most_samples;
    frame.explains = explain_;
    frame.split = kernels_ || !files.json.empty() || !files.trace_events.empty();
    std::optional<CheckedDevice> device;
    const auto device_start = Clock::now();
    if (on_device) device.emplace(open_device(device_, use_for(scene)));
    if (device) around.prepare_ms = ms_since(device_start);
    const FrameReport report = measured(device ? &*device : nullptr, scene, frame);

    const InterruptionGuard guard;  // no half-written file
    const auto write_start = Clock::now();
    if (frame.trace.keep_radiance)
      write_exr(files.picture, frame.trace.width, frame.trace.height, report.radiance);
    else
      write_png(files.picture, frame.trace.width, frame.trace.height, report.image);
    around.write_ms = ms_since(write_start);
    if (files.talks()) print(text_of(report, scene, frame, around));
    write_json(files.json, to_json(report, scene, frame, around));
    throw_if_interrupted();
    return device ? validation_status(*device) : 0;
  }

 private:
  bool traces_on_device() const { return tracer_ == "gpu"; }

  // Without one the device traces no shadows, and looks at no alpha.
  void check_tree(const EffectSet& effects) const {
    if (builder_.name != "none" || show_.show != Show::color || !traces_on_device()) return;
    if (effects.follows_paths())
      throw InputError(
          "--builder none: paths of light are traced through a tree, which takes another builder "
          "(--effects=" +
          without(effects.path_effects()) + " goes without)");
    if (effects.has(Effect::shadows))
      throw InputError(
          "--builder none: shadows are traced through a tree, which takes another builder "
          "(--effects=-shadows goes without)");
    if (effects.has(Effect::alpha) && !effects.of(Effect::alpha).called_by.empty())
      throw InputError(
          "--builder none: alpha is looked at on the way through a tree, which takes another builder "
          "(--effects=-alpha goes without)");
    if (effects.has(Effect::ambient_occlusion))
      throw InputError(
          "--builder none: ambient occlusion is traced through a tree, which takes another builder "
          "(--effects=-ambient_occlusion goes without)");
  }

  // Otherwise instances are flattened: only trees of the device have two levels.
  bool traces_instances() const {
    return traces_on_device() && builder_.on_device() && device_.choices.walk.allows_binary() &&
           can_trace_wide(picture_.trace);
  }

  DeviceUse use_for(const Scene& scene) const {
    DeviceUse use{.builds = builder_.on_device() != nullptr,
                  .build = builder_.least_build_options(),
                  .traces = {},
                  .triangle_count = static_cast<std::uint32_t>(scene.indices.size()),
                  .instances = !scene.instances.empty()};
    if (traces_on_device() && !use.instances) use.traces.push_back(picture_.trace);
    return use;
  }

  FrameReport measured(CheckedDevice* device, const Scene& scene, FrameRuns& frame) const {
    const SceneArrays arrays = picture_arrays(scene, frame.effects);
    if (!traces_on_device()) return measure_host_frame(device, scene, arrays, frame, print_note);
    frame.trace = device->picture_options(frame.trace, static_cast<std::uint32_t>(scene.indices.size()));
    if (!scene.instances.empty()) frame.trace.walk = Walk::binary;
    return measure_frame(*device, scene, arrays, frame);
  }

  std::string tracer_ = "gpu";
  bool kernels_ = false, explain_ = false;
  std::uint32_t runs_ = 1;
  SceneOptions scene_;
  PictureOptions picture_;
  RefineLimits refine_;
  ShowOptions show_;
  BuilderChoice builder_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_render() { return std::make_unique<RenderCommand>(); }

}  // namespace coppice
