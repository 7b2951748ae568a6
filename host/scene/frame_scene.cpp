#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "scene/bounds.h"
#include "scene/instances.h"
#include "scene/motion.h"
#include "scene/scene.h"

namespace coppice {
namespace {

// How far from the centre, along `toward_camera`, all triangles that count come into view.
template <class Counts>
double viewing_distance(const Scene& scene, Counts counts, glm::dvec3 centre, glm::dvec3 toward_camera,
                        double tan_x, double tan_y) {
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3{0, 1, 0}, toward_camera));
  const glm::dvec3 up = glm::cross(toward_camera, right);
  double distance = 0;
  for (const glm::uvec3 triangle : scene.indices) {
    if (!counts(scene, triangle)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p = glm::dvec3{scene.positions[triangle[corner]]} - centre;
      const double sideways =
          std::max(std::abs(glm::dot(p, right)) / tan_x, std::abs(glm::dot(p, up)) / tan_y);
      distance = std::max(distance, glm::dot(p, toward_camera) + sideways);
    }
  }
  return distance;
}

glm::vec3 clamp_to_float(glm::dvec3 p) {
  const double limit = std::numeric_limits<float>::max();
  return glm::vec3{glm::clamp(p, -limit, limit)};
}

// The scene as it stands at later times of a cycle; none where nothing moves.
std::vector<Scene> later_moments(const Scene& scene) {
  constexpr int count = 8;
  std::vector<Scene> moments;
  for (int k = 1; scene.motion && k < count; ++k) {
    moments.push_back(scene);
    moments.back().positions = positions_at(*scene.motion, scene.motion->duration_seconds * k / count);
  }
  return moments;
}

}  // namespace

Camera frame_scene(const Scene& scene, float aspect) {
  if (scene.camera) return *scene.camera;
  if (!scene.instances.empty()) return frame_scene(boxes_of_instances(scene), aspect);

  Camera camera;
  const glm::dvec3 toward_camera = glm::normalize(glm::dvec3{0.55, 0.42, 0.83});
  const double tan_y = std::tan(glm::radians(static_cast<double>(camera.vertical_fov_degrees)) / 2);
  const std::vector<Scene> later = later_moments(scene);
  Bounds bounds = visible_bounds(scene);
  for (const Scene& moment : later) {
    const Bounds its = visible_bounds(moment);
    bounds.low = glm::min(bounds.low, its.low);
    bounds.high = glm::max(bounds.high, its.high);
  }
  const glm::dvec3 centre = bounds.centre();
  const auto distance_of = [&](auto counts) {
    const auto at = [&](const Scene& moment) {
      return viewing_distance(moment, counts, centre, toward_camera, tan_y * aspect, tan_y);
    };
    double distance = at(scene);
    for (const Scene& moment : later) distance = std::max(distance, at(moment));
    return 1.05 * distance;
  };
  double distance = distance_of(is_visible);
  if (distance == 0) distance = distance_of(is_active);
  if (distance == 0) distance = 1;  // nothing, or a single point: any distance will do
  // Far from the origin, or near the least normal float, the step back must survive rounding to float.
  distance = std::max({distance, 0x1p-21 * bounds.reach(), 4.0 * std::numeric_limits<float>::min()});

  camera.target = clamp_to_float(centre);
  camera.position = clamp_to_float(centre + distance * toward_camera);
  // At the corner of float's range there is no room to step back: look from the other side.
  if (camera.position == camera.target) camera.position = clamp_to_float(centre - distance * toward_camera);
  return camera;
}

}  // namespace coppice
