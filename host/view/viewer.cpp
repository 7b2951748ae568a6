#define GLFW_INCLUDE_VULKAN
#include "view/viewer.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>

#include "gpu/device.h"
#include "measure/table.h"
#include "pipeline/interruption.h"
#include "pipeline/verdicts.h"
#include "scene/input_error.h"

namespace coppice {

namespace {

using ViewClock = std::chrono::steady_clock;

double seconds_between(ViewClock::time_point from, ViewClock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

bool same_scene(const ViewSettings& a, const ViewSettings& b) {
  return a.scene.spec == b.scene.spec && a.scene.up == b.scene.up;
}

// Of the last frames, however many there are.
void keep_time(std::vector<double>& times, double ms) {
  constexpr std::size_t most = 1u << 16;
  if (times.size() == most) times.erase(times.begin(), times.begin() + most / 2);
  times.push_back(ms);
}

}  // namespace

bool same_tree(const ViewSettings& a, const ViewSettings& b) {
  return a.builder.name == b.builder.name && a.builder.radius == b.builder.radius &&
         a.builder.morton_bits == b.builder.morton_bits && a.builder.leaf_size == b.builder.leaf_size &&
         a.update == b.update;
}

Viewer::Viewer(const ViewRun& run, const Note& note)
    : run_(run),
      note_(note),
      window_({.title = "Coppice",
               .width = static_cast<int>(run.trace.width),
               .height = static_cast<int>(run.trace.height),
               .select = run.device.select,
               .validate = run.device.validate}),
      screen_(std::in_place, with_input(window_)),
      plays_(!run.paused),
      panes_(run.panes),
      typed_scene_(run.scene.spec) {
  asked_ = {.scene = run.scene, .builder = run.builder, .walk = run.choices.walk, .show = run.show};
  asked_.rebuild = run.rebuild;
  asked_.update = run.update;
  asked_.draws_always = run.frames != 0;
  shown_ = asked_;
  camera_numbers_ = run.camera;
}

Viewer::~Viewer() {
  wait_for_device();
  glfwSetWindowUserPointer(window_.handle(), nullptr);
}

void Viewer::say(const std::string& line) const {
  if (!run_.talks) return;
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

void Viewer::complain(const std::string& line) {
  complaint_ = line;
  std::fprintf(stderr, "coppice: %s\n", line.c_str());
}

bool Viewer::goes_on() const {
  throw_if_interrupted();
  if (glfwWindowShouldClose(window_.handle())) return false;
  return run_.frames == 0 || presented_ < run_.frames;
}

bool Viewer::is_hidden() const {
  const VkExtent2D size = window_.framebuffer();
  return size.width == 0 || size.height == 0;
}

// Whether each frame has another picture.
bool Viewer::moves() const {
  return frames_ && ((plays_ && frames_->can_move()) || asked_.rebuild || asked_.draws_always);
}

// Until something happens, where nothing goes on by itself.
void Viewer::wait_for_events() {
  const bool still =
      frames_ && !moves() && !picture_old_ && !typed_keys_.any_left() && samples_of_next_pass() == 0;
  if (is_hidden()) {
    glfwWaitEventsTimeout(0.1);
  } else if (still || !frames_) {
    glfwWaitEventsTimeout(still ? 0.25 : 0.02);
  } else {
    glfwPollEvents();
  }
}

ViewReport Viewer::run() {
  check_device();
  start_scene();
  last_turn_ = ViewClock::now();
  while (goes_on()) {
    wait_for_events();
    try {
      turn();
    } catch (const DeviceLost& lost) {
      if (device_is_new_ || presented_ == 0) throw;  // it would be lost again
      remake_device(lost.what());
    }
  }
  screen_->wait();
  return report();
}

void Viewer::turn() {
  const auto now = ViewClock::now();
  const double passed = seconds_between(last_turn_, now);
  last_turn_ = now;
  take_scene();
  if ((opened_ || presented_ > 0) &&
      (!same_scene(asked_, shown_) || wants_other_levels() ||
       (!same_tree(asked_, shown_) && !(asked_.builder.on_device() && shown_.builder.on_device()))))
    start_scene();
  remake_frames();
  move_camera(std::min(passed, 0.1));
  move_time(std::min(passed, 0.5));
  if (is_hidden()) return;
  submit_picture();
  if (asked_.show.show == Show::boxes) take_picture();  // the panes draw the lines of its tree
  if (!show_picture() || !frames_) return;
  device_is_new_ = false;
  ++presented_;
  if (presented_ > 1) keep_time(frame_ms_, passed * 1000);
  answer_requests();
}

// With the panes over it.
bool Viewer::show_picture() {
  typed_keys_.begin_frame();
  screen_->begin();
  panes();
  typed_keys_.end_frame(window_.handle());
  take_picture();
  PicturePlace picture;
  if (frames_) picture = {frames_->image_buffer(), frames_->image().place.offset, width_, height_};
  return screen_->show(picture);
}

void Viewer::start_scene() {
  shown_.scene = asked_.scene;
  shown_.builder = asked_.builder;
  asked_.scene.keep_instances = shown_.scene.keep_instances = keeps_instances(asked_.builder, asked_.walk);
  job_.start(asked_.scene, asked_.builder);
}

// Whether the scene is to be opened again, as its instances are flattened, or are to be.
bool Viewer::wants_other_levels() const {
  return opened_ && opened_->has_instances && !job_.is_under_way() &&
         opened_->options.keep_instances != keeps_instances(asked_.builder, asked_.walk);
}

void Viewer::take_scene() {
  SceneJob::Result result = job_.take();
  if (!result.complaint.empty()) {
    if (presented_ == 0) throw InputError(result.complaint);
    complain(result.complaint);
    if (opened_) {
      asked_.scene = shown_.scene = opened_->options;
      asked_.builder = shown_.builder = opened_->builder;
    }
  }
  if (!result.opened) return;
  const bool is_new = !opened_ || opened_->options.spec != result.opened->options.spec;
  screen_->wait();
  frames_.reset();
  refused_ = {};
  opened_ = std::move(result.opened);
  complaint_.clear();
  if (!is_new) return;
  for (const std::string& warning : opened_->scene.warnings)
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (presented_ > 0) camera_numbers_.clear();
  camera_.reset();
  seconds_ = 0;
  say(format("scene %s: %u triangles%s", shell_word(opened_->options.spec).c_str(),
             opened_->arrays.triangle_count(), cycle_of(opened_->scene) ? ", moving" : ""));
}

void Viewer::submit_picture() {
  if (!frames_) return;
  const Film film = film_at_time();
  submit_time_ = ViewClock::now();
  if (!moves() && !picture_old_ && !request_.rebuild && seconds_ == drawn_seconds_) {
    if (const std::uint32_t samples = samples_of_next_pass()) frames_->submit_pass(film_, samples);
    return;
  }
  frames_->submit(film, seconds_, asked_.rebuild || request_.rebuild);
  request_.rebuild = false;
  film_ = film;
  drawn_seconds_ = seconds_;
  picture_old_ = false;
}

// 0: none. As many as take about as long as a window may be late to answer, and at first two, of which one
// knows how far they are apart.
std::uint32_t Viewer::samples_of_next_pass() const {
  constexpr double seconds_of_pass = 0.05;
  if (!frames_ || !frames_->can_refine() || asked_.show.show != Show::color) return 0;
  const ViewedFrame& last = statistics_.last;
  const RefineLimits& limits = run_.refine;
  if (last.samples >= limits.most_samples || is_refined(last)) return 0;
  const std::uint32_t done = last.samples > 1 ? last.samples : 0, left = limits.most_samples - done;
  const double in_time = seconds_of_pass / std::max(seconds_a_sample_, 1e-6);
  return std::min(left, std::max(static_cast<std::uint32_t>(in_time), done == 0 ? 2u : 1u));
}

bool Viewer::is_refined(const ViewedFrame& frame) const {
  const RefineLimits& limits = run_.refine;
  return limits.error > 0 && frame.samples >= REFINE_LEAST_SAMPLES && frame.error <= limits.error;
}

void Viewer::take_picture() {
  if (!frames_ || !frames_->is_under_way()) return;
  const std::uint32_t before = statistics_.last.samples;
  const ViewedFrame frame = frames_->take();
  const double seconds = seconds_between(submit_time_, ViewClock::now());
  seconds_a_sample_ =
      seconds / (frame.samples > before && before > 1 ? frame.samples - before : frame.samples);
  note_frame(frame, seconds * 1000);
  if (frame.samples > 1 && samples_of_next_pass() == 0)
    say(format("refined to %u samples, error %.3g", frame.samples, frame.error));
}

void Viewer::note_frame(const ViewedFrame& frame, double ms) {
  ++drawn_;
  keep_time(device_ms_, frame.device_ms);
  statistics_.last = frame;
  statistics_.frames.push_back({ms, frame.device_ms, frame.groups, frame.built});
  if (statistics_.frames.size() > ViewStatistics::kept) statistics_.frames.pop_front();
  for (const KernelGroup& group : frame.groups) {
    if (std::ranges::find(statistics_.groups, group.name) == statistics_.groups.end())
      statistics_.groups.push_back(group.name);
  }
  // Of a tree that changes a few times a second, as it has to be read from the device.
  const auto now = ViewClock::now();
  const bool shows_boxes = asked_.show.show == Show::boxes;
  if (shows_boxes && (frame.built || frame.refitted || boxes_.empty())) boxes_ = frames_->tree();
  if (!shows_boxes) boxes_.clear();
  if (statistics_.has_tree &&
      (!(frame.built || frame.refitted) || seconds_between(last_description_, now) < 0.5))
    return;
  if (!panes_ && statistics_.has_tree) return;
  statistics_.tree = frames_->describe();
  statistics_.has_tree = true;
  last_description_ = now;
}

}  // namespace coppice
