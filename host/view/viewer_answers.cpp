#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <filesystem>

#include "analysis/tree_hash.h"
#include "measure/table.h"
#include "render/box_lines.h"
#include "scene/input_error.h"
#include "scene/write_png.h"
#include "view/viewer.h"

namespace coppice {

// For a shell.
std::string shell_word(const std::string& word) {
  if (!word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                              "_-./:,+=") == std::string::npos)
    return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

void Viewer::answer_requests() {
  if (request_.picture) write_picture();
  if (request_.camera) copy_camera();
  request_.picture = request_.camera = false;
}

void Viewer::write_picture() {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path path;
  for (int number = 1; number < 100000; ++number) {
    path = run_.pictures + format("-%03d.png", number);
    if (!fs::exists(path, error)) break;
  }
  std::vector<uint> image = frames_->picture();
  if (asked_.show.show == Show::boxes)
    draw_box_lines(image, width_, height_, box_lines(frames_->tree(), film_, asked_.show.level, BOXES_SHOWN),
                   asked_.show.level);
  try {
    write_png(path, width_, height_, image);
    say("wrote " + path.string());
  } catch (const InputError& failed) {
    complain(failed.what());
  }
}

std::string Viewer::render_arguments() const {
  const ShowOptions& show = asked_.show;
  std::string text = "render " + shell_word(asked_.scene.spec);
  if (asked_.scene.up != "y") text += " --up=" + asked_.scene.up;
  text += format(" --size %ux%u --builder %s --radius %u", width_, height_, asked_.builder.name.c_str(),
                 asked_.builder.radius);
  if (!asked_.walk.automatic()) text += " " + asked_.walk.said;
  // Samples of a sequence, as many as there are: a day is enough for them.
  if (const std::uint32_t samples = statistics_.last.samples; samples > 1)
    text += format(" --spp %u --seconds 86400", samples);
  if (!asked_.scene.effects.empty()) text += " --effects=" + asked_.scene.effects.text();
  if (show.show != Show::color) text += " --show " + std::string(name_of(show.show));
  if (show.show == Show::steps && show.most_steps) text += format(" --most-steps %u", show.most_steps);
  if (show.show == Show::clusters) text += format(" --round %u", show.round);
  if (show.show == Show::boxes) text += format(" --level %u", show.level);
  return text + " --camera=" + camera_text(camera_numbers_.empty() ? camera_now() : camera_numbers_);
}

void Viewer::copy_camera() {
  const std::string text = render_arguments();
  glfwSetClipboardString(window_.handle(), text.c_str());
  say(text);
}

ViewReport Viewer::report() {
  ViewReport report;
  report.scene = asked_.scene.spec;
  report.builder = asked_.builder.name;
  report.device = device_->properties().name;
  report.driver = device_->properties().driver;
  report.frames = drawn_;
  report.width = width_;
  report.height = height_;
  report.frame_ms = frame_ms_;
  report.device_ms = device_ms_;
  if (opened_) report.triangles = opened_->arrays.triangle_count();
  if (frames_) {
    report.walk = name_of(frames_->walk());
    report.image_hash = image_hash(frames_->picture());
  }
  report.validation_messages = window_.take_validation_messages();
  return report;
}

}  // namespace coppice
