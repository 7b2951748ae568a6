#include "view/camera_control.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace coppice {

namespace {

// Straight up and down the picture would have no upper edge.
constexpr double steepest = 89.5 / 180 * std::numbers::pi;

}  // namespace

CameraControl::CameraControl(const View& view, double size)
    : target_(view.target),
      distance_(glm::length(view.target - view.eye)),
      yaw_(std::atan2(view.forward.x, -view.forward.z)),
      pitch_(std::clamp(std::asin(std::clamp(view.forward.y, -1.0, 1.0)), -steepest, steepest)),
      size_(size),
      fov_(view.vertical_fov_degrees) {}

glm::dvec3 CameraControl::direction() const {
  return {std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_), -std::cos(yaw_) * std::cos(pitch_)};
}

void CameraControl::turn(double right, double down) {
  yaw_ = std::remainder(yaw_ + right, 2 * std::numbers::pi);
  pitch_ = std::clamp(pitch_ - down, -steepest, steepest);
}

void CameraControl::orbit(double right, double down) {
  turn(right * std::numbers::pi, down * std::numbers::pi);
}

void CameraControl::look(double right, double down) {
  const glm::dvec3 eye = target_ - direction() * distance_;
  const double angle = fov_ / 180 * std::numbers::pi;
  turn(right * angle, down * angle);
  target_ = eye + direction() * distance_;
}

void CameraControl::pan(double right, double down) {
  const double height = 2 * distance_ * std::tan(fov_ / 360 * std::numbers::pi);
  const glm::dvec3 to_right{std::cos(yaw_), 0, std::sin(yaw_)};
  const glm::dvec3 to_below = glm::cross(direction(), to_right);
  target_ -= (to_right * right + to_below * down) * height;
}

void CameraControl::zoom(double steps) {
  distance_ = std::clamp(distance_ * std::pow(0.9, steps), 1e-5 * size_, 1e5 * size_);
}

void CameraControl::fly(double forward, double right, double up) {
  const glm::dvec3 to_right{std::cos(yaw_), 0, std::sin(yaw_)};
  target_ += (direction() * forward + to_right * right + glm::dvec3{0, up, 0}) * size_;
}

std::vector<double> CameraControl::numbers(const Scene& scene) const {
  const glm::dvec3 eye = to_file(scene, target_ - direction() * distance_), target = to_file(scene, target_);
  return {eye.x, eye.y, eye.z, target.x, target.y, target.z, fov_};
}

std::vector<double> camera_numbers(const Scene& scene, const View& view) {
  const glm::dvec3 eye = to_file(scene, view.eye), target = to_file(scene, view.target);
  std::vector<double> numbers = {
      eye.x, eye.y, eye.z, target.x, target.y, target.z, view.vertical_fov_degrees};
  const glm::dvec3 up = direction_to_file(scene, -view.down);
  if (glm::length(given_view(scene, numbers).down - view.down) > 1e-6)
    numbers.insert(numbers.end(), {up.x, up.y, up.z});
  return numbers;
}

std::string camera_text(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    text.append(text.empty() ? "" : ",").append(digits, end);
  }
  return text;
}

}  // namespace coppice
