#include <algorithm>
#include <cstdio>

#include "gpu/device.h"
#include "measure/table.h"
#include "pipeline/verdicts.h"
#include "view/viewer.h"

namespace coppice {

namespace {

bool same_show(const ShowOptions& a, const ShowOptions& b) {
  return a.show == b.show && a.most_steps == b.most_steps && a.round == b.round && a.level == b.level;
}

}  // namespace

void Viewer::check_device() {
  screen_->begin();
  messages();
  screen_->show({});  // the kernels may have to be compiled for the check
  const DeviceUse use{.build = run_.builder.least_build_options(), .traces = {run_.trace}, .inputs = true};
  device_.emplace(Device(window_.adopted(), run_.device.pipeline_folder, run_.device.log), run_.choices, use,
                  note_);
}

// Before things are freed that it may still use; one that is lost uses nothing.
void Viewer::wait_for_device() const {
  if (window_.device) (void)vkDeviceWaitIdle(window_.device);
}

// All that is of the device goes with it; scene, camera and time stay.
void Viewer::remake_device(const char* reason) {
  std::fprintf(stderr, "coppice: %s; it is made anew\n", reason);
  wait_for_device();
  frames_.reset();
  device_.reset();
  screen_.reset();
  window_.remake_device();
  screen_.emplace(window_);
  device_is_new_ = true;
  check_device();
}

VkExtent2D Viewer::wanted_size() const {
  const VkExtent2D size = window_.framebuffer();
  return {std::max(size.width / asked_.divide, 1u), std::max(size.height / asked_.divide, 1u)};
}

// For another size, builder, tracer or view than those of the last picture.
void Viewer::remake_frames() {
  if (!opened_ || is_hidden()) return;
  auto [width, height] = wanted_size();
  if (width == refused_.width && height == refused_.height) {
    width = width_;
    height = height_;
  }
  const bool same_kernels = kernel_view(asked_.show.show) == kernel_view(shown_.show.show);
  if (frames_ && width == width_ && height == height_ && same_tree(asked_, shown_) && same_kernels &&
      asked_.walk.said == shown_.walk.said) {
    if (!same_show(asked_.show, shown_.show)) {
      frames_->set_show(asked_.show);
      picture_old_ = true;
    }
    shown_ = asked_;
    return;
  }
  if (job_.is_under_way() && !asked_.builder.on_device()) return;  // its tree is yet to come
  const bool had_frames = frames_ != nullptr;
  try {
    make_frames(width, height);
  } catch (const DeviceHung&) {
    throw;
  } catch (const DeviceLost&) {
    throw;
  } catch (const std::exception& error) {  // too large for the device, or a view that the tracer has not
    if (presented_ == 0) throw;
    const bool resized = had_frames && (width != width_ || height != height_);
    complain(error.what() + (resized ? format("; the picture stays %ux%u, scaled", width_, height_) : ""));
    if (!had_frames) {  // a new scene, which is given up
      opened_.reset();
      return;
    }
    asked_ = shown_;
    refused_ = wanted_size();
    make_frames(width_, height_);
  }
  shown_ = asked_;
}

void Viewer::make_frames(std::uint32_t width, std::uint32_t height) {
  screen_->wait();
  frames_.reset();
  ViewOptions options{
      .builder = asked_.builder, .trace = run_.trace, .show = asked_.show, .update = asked_.update};
  options.refines = run_.refine.most_samples > 1;
  options.trace.width = width;
  options.trace.height = height;
  device_->set_walk(asked_.walk);
  DeviceUse use{.builds = options.builder.on_device() != nullptr,
                .traces = {device_->picture_options(options.trace, opened_->arrays.triangle_count())},
                .refits = asked_.update != Update::rebuild,
                .inputs = true,
                .vertices = opened_->scene.motion != nullptr,
                .instances = !opened_->scene.instances.empty()};
  if (use.instances) use.traces.clear();
  use.build = device_->build_options(options.builder.least_build_options());
  kept_check_device(device_->device(), use);
  frames_ = std::make_unique<ViewFrames>(*device_, *opened_, options);
  if (width != width_ || height != height_) say(format("size %ux%u", width, height));
  width_ = width;
  height_ = height;
  if (camera_numbers_.empty() && !camera_moves()) camera_numbers_ = camera_now();
  picture_old_ = true;
  statistics_ = {};
}

}  // namespace coppice
