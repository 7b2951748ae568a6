#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scene/motion.h"
#include "view/viewer.h"

namespace coppice {

namespace {

double size_of(const Aabb& box) {
  const double size = glm::length(glm::dvec3(box.box_max) - glm::dvec3(box.box_min));
  return size > 0 && std::isfinite(size) ? size : 1;
}

}  // namespace

void Viewer::move_camera(double seconds) {
  if (!frames_) return;
  const auto held = [&](int key) {
    const bool down =
        glfwGetKey(window_.handle(), key) == GLFW_PRESS || std::ranges::find(pressed_, key) != pressed_.end();
    return down && !typed_keys_.has_field() ? 1 : 0;
  };
  const double speed = 0.25 * seconds * (held(GLFW_KEY_LEFT_SHIFT) ? 4 : 1);
  const double forward = speed * (held(GLFW_KEY_W) - held(GLFW_KEY_S));
  const double right = speed * (held(GLFW_KEY_D) - held(GLFW_KEY_A));
  const double up = speed * (held(GLFW_KEY_E) - held(GLFW_KEY_Q));
  const bool moves = forward != 0 || right != 0 || up != 0 || turns_.x != 0 || turns_.y != 0 ||
                     pans_.x != 0 || pans_.y != 0 || zooms_ != 0;
  if (request_.reset) {
    camera_.reset();
    camera_numbers_.clear();
    if (!camera_moves()) camera_numbers_ = camera_now();
    request_.reset = false;
    picture_old_ = true;
  }
  if (moves && !camera_) {
    if (camera_numbers_.empty()) camera_numbers_ = camera_now();
    camera_.emplace(given_view(opened_->scene, camera_numbers_), size_of(opened_->box));
  }
  if (moves) {
    const double pixels = std::max(static_cast<double>(window_.framebuffer().height), 1.0);
    if (flies_) {
      camera_->look(turns_.x / pixels, turns_.y / pixels);
    } else {
      camera_->orbit(turns_.x / pixels, turns_.y / pixels);
    }
    camera_->pan(pans_.x / pixels, pans_.y / pixels);
    if (flies_) {
      camera_->fly(0.02 * zooms_, 0, 0);
    } else {
      camera_->zoom(zooms_);
    }
    camera_->fly(forward, right, up);
    camera_numbers_ = camera_->numbers(opened_->scene);
    picture_old_ = true;
  }
  turns_ = pans_ = {};
  zooms_ = 0;
  pressed_.clear();
}

void Viewer::move_time(double seconds) {
  if (!frames_ || !frames_->can_move()) return;
  if (!plays_ || presented_ == 0) return;
  seconds_ = run_.frames == 0 ? seconds_ + seconds : static_cast<double>(presented_) / frames_per_second();
}

bool Viewer::camera_moves() const {
  const Motion* const motion = opened_->scene.motion.get();
  return motion && opened_->scene.camera && pose_at(*motion, seconds_).camera.has_value();
}

// Where nobody has moved it.
std::vector<double> Viewer::camera_now() const {
  const Scene& scene = opened_->scene;
  if (camera_moves())
    return coppice::camera_numbers(scene, view_of(*pose_at(*scene.motion, seconds_).camera));
  return coppice::camera_numbers(scene, choose_view(scene, {}, width_, height_));
}

// By the camera that was given or moved, or the one of the scene, as it moves.
Film Viewer::film_at_time() const {
  const Scene& scene = opened_->scene;
  if (camera_numbers_.empty() && camera_moves())
    return make_film(*pose_at(*scene.motion, seconds_).camera, scene.lens, width_, height_, 1);
  return make_film(scene, camera_numbers_, width_, height_, 1);
}

double Viewer::frames_per_second() const {
  const auto cycle = opened_ ? cycle_of(opened_->scene) : std::nullopt;
  return cycle ? cycle->frames_per_second : 30;
}

double Viewer::scene_duration() const {
  const auto cycle = opened_ ? cycle_of(opened_->scene) : std::nullopt;
  return cycle ? cycle->seconds : 1;
}

}  // namespace coppice
