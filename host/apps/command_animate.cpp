#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "apps/option_rules.h"
#include "measure/animate.h"
#include "measure/child_process.h"
#include "measure/table.h"
#include "measure/tree_choice.h"
#include "pipeline/interruption.h"
#include "scene/input_error.h"
#include "scene/motion.h"
#include "scene/printable.h"
#include "scene/write_file.h"
#include "scene/write_png.h"

namespace coppice {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t most_frames = 1'000'000;
constexpr double video_limit_seconds = 3600;

// The folder of pictures, each of which appears whole or not at all.
class Pictures {
 public:
  Pictures() = default;

  // Makes the folder, and sees that it takes files. Throws InputError.
  explicit Pictures(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (!fs::is_directory(folder_)) throw InputError(printable(folder_) + ": cannot be made a folder");
    check_writable(folder_ / "frame");
  }

  bool has(std::uint32_t number) const {
    std::error_code error;
    return !folder_.empty() && fs::exists(path_of(number), error);
  }
  void write(std::uint32_t number, const TraceOptions& trace, std::span<const uint> image) const {
    if (!folder_.empty()) write_png(path_of(number), trace.width, trace.height, image);
  }
  // As ffmpeg reads it.
  static std::string pattern_in(const fs::path& folder) {
    std::string pattern = folder.string();
    for (std::size_t at = 0; (at = pattern.find('%', at)) != std::string::npos; at += 2)
      pattern.insert(at, "%");
    return (fs::path(pattern) / "frame_%05d.png").string();
  }

 private:
  fs::path path_of(std::uint32_t number) const { return folder_ / format("frame_%05u.png", number); }

  fs::path folder_;
};

class AnimateCommand : public Command {
 public:
  AnimateCommand() {
    builder_.name = "auto";
    picture_.trace.width = 640;
    picture_.trace.height = 360;
  }

  void add_options(CLI::App& app) override {
    app.add_option("--frames", frames_text_, "N: frames 0 to N - 1; A..B: frames A to B, both of them")
        ->type_name("N|A..B")
        ->capture_default_str();
    app.add_option("-o,--directory", folder_, "write pictures DIR/frame_00000.png and so on")
        ->type_name("DIR");
    app.add_flag("--skip-existing", skip_existing_, "leave out frames whose picture is in DIR");
    app.add_option("--fps", frames_per_second_, "frames a second of the scene (default: the scene's)")
        ->check(CLI::Range(0.001, 100000.0));
    app.add_option("--video", video_, "then make FILE.mp4 or FILE.webp of the pictures, by ffmpeg")
        ->type_name("FILE");
    add_update(app, update_);
    app.add_flag("--tree-cost", tree_cost_, "the SAH cost of every frame's tree; --plot and --csv imply it");
    app.add_option("--plot", files.plot, "curves over the frames, as SVG")->type_name("FILE");
    app.add_option("--csv", files.csv, "every frame, comma-separated")->type_name("FILE");
    app.add_flag("--kernels", kernels_, "print the time of every kernel of one frame");
    add_picture(app, picture_, scene_.up);
    add_effects(app, scene_);
    add_lens(app, scene_);
    add_tone(app, picture_.trace.tone);
    add_tree(app, device_.choices.walk);
    add_trace_events(app, files.trace_events);
    std::vector<std::string> builders = device_builder_names();
    builders.insert(builders.begin(), builder_.name);
    add_scene_and_build(app, scene_, builder_, device_, builders);
  }

  void check(const CLI::App&) override {
    parse_view(picture_);
    parse_frames();
    const bool tries = last_ - first_ >= frames_worth_trying - 1;
    if (builder_.name == "auto") {
      builders_ = {"gpu-hploc", "gpu-ploc", "gpu-lbvh"};
      builder_.name = builders_.front();
    }
    if (!tries) builders_.clear();
    tries_walks_ = tries && device_.choices.walk.automatic();
    if (std::isnan(frames_per_second_)) throw CLI::ValidationError("--fps: 'nan' is no number of frames");
    if (skip_existing_ && folder_.empty())
      throw CLI::ValidationError("--skip-existing needs the pictures of -o DIR");
    if (video_.empty()) return;
    if (folder_.empty()) throw CLI::ValidationError("--video needs the pictures of -o DIR");
    const std::string ending = fs::path(video_).extension();
    if (ending != ".mp4" && ending != ".webp")
      throw CLI::ValidationError("--video: '" + printable(fs::path(video_)) +
                                 "' does not end in .mp4 or .webp");
  }

  std::vector<std::string> scenes() const override { return {scene_.spec}; }

  int run() override {
    if (!video_.empty()) check_writable(video_);
    const Pictures pictures = folder_.empty() ? Pictures() : Pictures(folder_);
    scene_.keep_instances = traces_instances();
    const Scene scene = open_for_effects(scene_, builder_, device_, true, false);
    const std::optional<SceneCycle> cycle = cycle_of(scene);
    if (!cycle) print_note(why_still(scene));
    AnimateRuns runs{.builder = builder_, .trace = picture_.trace, .camera = picture_.camera};
    runs.update = update_;
    runs.tree_cost = tree_cost_ || !files.plot.empty() || !files.csv.empty();
    runs.first = first_;
    runs.last = last_;
    runs.frames_per_second = frames_per_second_ > 0 ? frames_per_second_
                             : cycle                ? cycle->frames_per_second
                                                    : 30;
    if (skip_existing_) runs.skip = [&](std::uint32_t number) { return pictures.has(number); };
    runs.picture = [&](std::uint32_t number, std::span<const uint> image) {
      pictures.write(number, picture_.trace, image);
    };
    runs.split = kernels_ || !files.json.empty() || !files.trace_events.empty();
    runs.trace_events = files.trace_events;
    CheckedDevice device = open_device(device_, use_for(scene));
    runs.trace = device.picture_options(runs.trace, static_cast<std::uint32_t>(scene.indices.size()));
    if (!scene.instances.empty()) runs.trace.walk = Walk::binary;
    std::vector<Walk> walks = {runs.trace.walk};
    if (tries_walks_ && scene.instances.empty()) walks = {Walk::binary, device.wide_walk()};
    SceneArrays arrays = picture_arrays(scene, scene_.effects);
    runs.tried = choose_tree(device, scene, arrays, runs,
                             builders_.empty() ? std::vector{builder_.name} : builders_, walks);
    const AnimateReport report = animate(device, scene, std::move(arrays), runs);
    if (files.talks()) print(text_of(report));
    if (!files.csv.empty()) write_file(files.csv, to_csv(report));
    if (!files.plot.empty()) write_file(files.plot, to_svg(report));
    write_json(files.json, to_json(report));
    make_video(runs.frames_per_second);  // last: whatever ffmpeg does, the rest is there
    return validation_status(device);
  }

 private:
  void parse_frames() {
    const auto fail = [&] {
      throw CLI::ValidationError("--frames: '" + printable(std::string_view(frames_text_)) +
                                 "' is neither N nor A..B, of at most " + std::to_string(most_frames) +
                                 " frames");
    };
    const auto number = [&](std::string_view text) {
      std::uint32_t value = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || end != text.data() + text.size() || value > most_frames) fail();
      return value;
    };
    const std::size_t dots = frames_text_.find("..");
    if (dots == std::string::npos) {
      const std::uint32_t count = number(frames_text_);
      if (count == 0) fail();
      last_ = count - 1;
      return;
    }
    first_ = number(std::string_view(frames_text_).substr(0, dots));
    last_ = number(std::string_view(frames_text_).substr(dots + 2));
    if (last_ < first_) fail();
  }

  // Otherwise they are flattened.
  bool traces_instances() const { return device_.choices.walk.allows_binary(); }

  std::string why_still(const Scene& scene) const {
    return "nothing moves in scene '" + scene.name + "': all frames are the same" +
           (traces_instances() ? "" : " (instances move with --tree binary)");
  }

  DeviceUse use_for(const Scene& scene) const {
    DeviceUse use{.build = builder_.least_build_options(),
                  .triangle_count = static_cast<std::uint32_t>(scene.indices.size()),
                  .refits = update_ != Update::rebuild,
                  .inputs = true,
                  .vertices = scene.motion != nullptr,
                  .instances = !scene.instances.empty()};
    if (!use.instances) use.traces = {picture_.trace};
    return use;
  }

  // Of the pictures from the first frame of this run on, as far as they follow each other.
  void make_video(double frames_per_second) const {
    if (video_.empty()) return;
    std::vector<std::string> words = {"-nostdin",
                                      "-y",
                                      "-loglevel",
                                      "error",
                                      "-framerate",
                                      format("%g", frames_per_second),
                                      "-start_number",
                                      std::to_string(first_),
                                      "-i",
                                      Pictures::pattern_in(folder_),
                                      "-frames:v",
                                      std::to_string(last_ - first_ + 1)};
    const bool webp = fs::path(video_).extension() == ".webp";
    const std::vector<std::string> how =
        webp ? std::vector<std::string>{"-c:v", "libwebp_anim", "-loop", "0", "-quality", "80"}
             : std::vector<std::string>{"-c:v",      "libx264",   "-pix_fmt", "yuv420p",
                                        "-crf",      "18",        "-vf",      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                        "-movflags", "+faststart"};
    words.insert(words.end(), how.begin(), how.end());
    const fs::path whole = video_, part = whole.parent_path() / (".part-" + whole.filename().string());
    words.push_back(part);
    const InterruptionGuard guard;  // no part of a film is left behind
    const ChildResult made = run_program("ffmpeg", words, video_limit_seconds);
    std::error_code error;
    if (made.exit_status == 0 && !made.timed_out) {
      fs::rename(part, whole, error);
      if (!error) return;
    }
    fs::remove(part, error);
    if (made.could_not_start) {
      print_note("no " + printable(whole) + ": ffmpeg is not installed; the pictures are in " +
                 printable(fs::path(folder_)));
      return;
    }
    throw InputError(printable(whole) + ": ffmpeg failed: " + made.error);
  }

  std::string frames_text_ = "120", folder_, video_;
  std::uint32_t first_ = 0, last_ = 0;
  double frames_per_second_ = 0;  // 0: the scene's
  Update update_ = Update::rebuild;
  std::vector<std::string> builders_;  // to choose from; empty: there is no choice
  bool tries_walks_ = false;
  bool tree_cost_ = false, skip_existing_ = false, kernels_ = false;
  SceneOptions scene_{.spec = "moving"};
  PictureOptions picture_;
  BuilderChoice builder_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_animate() { return std::make_unique<AnimateCommand>(); }

}  // namespace coppice
