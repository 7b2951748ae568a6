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

// A scene as it stands at several times of a cycle, one after the other; once where nothing moves.
class Moments {
 public:
  explicit Moments(const Scene& scene) : scene_(scene) {
    if (!scene.motion) return;
    moment_ = scene;
    const std::size_t count = count_for(scene.positions.size());
    for (std::size_t k = 1; k < count; ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(count);
      later_.push_back(positions_at(*scene.motion, scene.motion->duration_seconds * part));
    }
  }

  template <class See>
  void each(See see) {
    see(scene_);
    for (std::vector<glm::vec3>& positions : later_) {
      std::swap(moment_.positions, positions);
      see(moment_);
      std::swap(moment_.positions, positions);
    }
  }

 private:
  // What moves for a short time only is seen by many; of many vertices these would take long.
  static std::size_t count_for(std::size_t vertices) {
    constexpr std::size_t least = 8, most = 64, moved_vertices = 2'000'000;
    return std::clamp(moved_vertices / std::max<std::size_t>(vertices, 1), least, most);
  }

  const Scene& scene_;
  Scene moment_;
  std::vector<std::vector<glm::vec3>> later_;
};

// Of a scene with instances, at several times of a cycle too.
Scene boxes_in_motion(const Scene& scene) {
  Scene seen = boxes_of_instances(scene);
  constexpr int count = 8;
  for (int k = 1; scene.motion && k < count; ++k) {
    const Scene moment = boxes_of_instances(standing_at(scene, scene.motion->duration_seconds * k / count));
    const auto first = static_cast<std::uint32_t>(seen.positions.size());
    seen.positions.insert(seen.positions.end(), moment.positions.begin(), moment.positions.end());
    for (const glm::uvec3& corners : moment.indices) seen.indices.push_back(corners + first);
  }
  return seen;
}

}  // namespace

Camera frame_scene(const Scene& scene, float aspect) {
  if (scene.camera) return *scene.camera;
  if (!scene.instances.empty()) return frame_scene(boxes_in_motion(scene), aspect);

  Camera camera;
  const glm::dvec3 toward_camera = glm::normalize(glm::dvec3{0.55, 0.42, 0.83});
  const double tan_y = std::tan(glm::radians(static_cast<double>(camera.vertical_fov_degrees)) / 2);
  Moments moments(scene);
  Bounds bounds;
  moments.each([&](const Scene& moment) {
    const Bounds its = visible_bounds(moment);
    bounds.low = glm::min(bounds.low, its.low);
    bounds.high = glm::max(bounds.high, its.high);
  });
  const glm::dvec3 centre = bounds.centre();
  const auto distance_of = [&](auto counts) {
    double distance = 0;
    moments.each([&](const Scene& moment) {
      distance =
          std::max(distance, viewing_distance(moment, counts, centre, toward_camera, tan_y * aspect, tan_y));
    });
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
