#include "scene/view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace coppice {
namespace {

// Sine of the angle between up and the line of sight below which they count as parallel.
constexpr double PARALLEL = 1e-6;

struct Numbers {
  glm::dvec3 eye, target;
  double vertical_fov_degrees = Camera().vertical_fov_degrees;
  bool has_up = false;
  glm::dvec3 up{0.0};
};

Numbers read_numbers(std::span<const double> n) {
  Numbers result{.eye = {n[0], n[1], n[2]}, .target = {n[3], n[4], n[5]}};
  if (n.size() % 3 == 1) result.vertical_fov_degrees = n[6];
  if (n.size() >= 9) {
    result.has_up = true;
    result.up = {n[n.size() - 3], n[n.size() - 2], n[n.size() - 1]};
  }
  return result;
}

// Of any finite direction but 0, however long or short.
glm::dvec3 unit(glm::dvec3 v) {
  const glm::dvec3 size = glm::abs(v);
  return glm::normalize(v / std::max({size.x, size.y, size.z}));
}

// Halved, so that it does not overflow.
glm::dvec3 from_to(glm::dvec3 from, glm::dvec3 to) { return 0.5 * to - 0.5 * from; }

bool parallel(glm::dvec3 unit_a, glm::dvec3 unit_b) {
  return glm::length(glm::cross(unit_a, unit_b)) < PARALLEL;
}

View make_view(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 forward, glm::dvec3 up, double fov) {
  if (parallel(forward, up)) up = {0, 0, glm::dot(forward, up) > 0 ? 1 : -1};
  // Not parallel unless the camera's up is along z itself.
  if (parallel(forward, up)) up = {0, 1, 0};
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
  return {eye, target, forward, right, glm::cross(forward, right), fov};
}

}  // namespace

View view_of(const Camera& camera) {
  const glm::dvec3 eye{camera.position}, target{camera.target};
  const glm::dvec3 forward = unit(from_to(eye, target));
  return make_view(eye, target, forward, unit(glm::dvec3{camera.up}), camera.vertical_fov_degrees);
}

View given_view(const Scene& scene, std::span<const double> given) {
  const Numbers numbers = read_numbers(given);
  const glm::dvec3 forward = unit(direction_to_scene(scene, from_to(numbers.eye, numbers.target)));
  const glm::dvec3 up = numbers.has_up ? unit(direction_to_scene(scene, numbers.up)) : glm::dvec3{0, 1, 0};
  return make_view(to_scene(scene, numbers.eye), to_scene(scene, numbers.target), forward, up,
                   numbers.vertical_fov_degrees);
}

std::string complaint_about_view(std::span<const double> given) {
  if (given.size() < 6 || given.size() == 8 || given.size() > 10) {
    return "needs 6 numbers (eye, target), 7 (and the field of view), 9 (and up in place of it) or 10 (with "
           "both),"
           " not " +
           std::to_string(given.size());
  }
  if (!std::ranges::all_of(given, [](double x) { return std::isfinite(x); })) {
    return "all numbers must be finite";
  }
  const Numbers numbers = read_numbers(given);
  const glm::dvec3 forward = from_to(numbers.eye, numbers.target);
  if (forward == glm::dvec3{0}) return "eye and target are the same point";
  if (!(numbers.vertical_fov_degrees > 0 && numbers.vertical_fov_degrees < 180)) {
    return "the field of view must be between 0 and 180 degrees";
  }
  if (!numbers.has_up) return {};
  if (numbers.up == glm::dvec3{0}) return "up is 0,0,0";
  if (parallel(unit(forward), unit(numbers.up))) return "up is along the line of sight";
  return {};
}

}  // namespace coppice
