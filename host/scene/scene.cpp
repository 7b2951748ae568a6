#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

namespace coppice {
namespace {

bool is_finite(glm::vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

bool is_active(const Scene& scene, glm::uvec3 triangle) {
  return is_finite(scene.positions[triangle.x]) && is_finite(scene.positions[triangle.y]) &&
         is_finite(scene.positions[triangle.z]);
}

// In double, so that neither the extent nor the centre of a scene at the ends of the range of float
// overflows.
struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::max()};
  glm::dvec3 high{std::numeric_limits<double>::lowest()};

  bool empty() const { return low.x > high.x; }
};

Bounds active_bounds(const Scene& scene) {
  Bounds bounds;
  for (const glm::uvec3 triangle : scene.indices) {
    if (!is_active(scene, triangle)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p = scene.positions[triangle[corner]];
      bounds.low = glm::min(bounds.low, p);
      bounds.high = glm::max(bounds.high, p);
    }
  }
  return bounds;
}

// How far from the centre, along `toward_camera`, all active triangles come into view.
double viewing_distance(const Scene& scene, glm::dvec3 centre, glm::dvec3 toward_camera, double tan_x,
                        double tan_y) {
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3{0, 1, 0}, toward_camera));
  const glm::dvec3 up = glm::cross(toward_camera, right);
  double distance = 0;
  for (const glm::uvec3 triangle : scene.indices) {
    if (!is_active(scene, triangle)) continue;
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

}  // namespace

std::uint32_t count_inactive(const Scene& scene) {
  return static_cast<std::uint32_t>(std::count_if(scene.indices.begin(), scene.indices.end(),
                                                  [&](glm::uvec3 t) { return !is_active(scene, t); }));
}

void bring_into_range(Scene& scene) {
  const Bounds bounds = active_bounds(scene);
  if (bounds.empty()) return;
  const glm::dvec3 sizes = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
  const double largest = std::max({sizes.x, sizes.y, sizes.z});
  if (largest == 0 || (largest >= 0x1p-30 && largest <= 0x1p30)) return;
  const int exponent = 30 - std::ilogb(largest);
  const auto scaled = [exponent](float x) { return static_cast<float>(std::ldexp(double{x}, exponent)); };
  for (glm::vec3& position : scene.positions) {
    position = {scaled(position.x), scaled(position.y), scaled(position.z)};
  }
  if (scene.camera) {
    for (glm::vec3* const point : {&scene.camera->position, &scene.camera->target}) {
      *point = {scaled(point->x), scaled(point->y), scaled(point->z)};
    }
  }
  scene.scale_exponent += exponent;
}

Camera frame_scene(const Scene& scene, float aspect) {
  if (scene.camera) return *scene.camera;

  Camera camera;
  const glm::dvec3 toward_camera = glm::normalize(glm::dvec3{0.55, 0.42, 0.83});
  const double tan_y = std::tan(glm::radians(static_cast<double>(camera.vertical_fov_degrees)) / 2);
  const Bounds bounds = active_bounds(scene);
  const glm::dvec3 centre = bounds.empty() ? glm::dvec3{0} : 0.5 * (bounds.low + bounds.high);

  double distance = 1.05 * viewing_distance(scene, centre, toward_camera, tan_y * aspect, tan_y);
  if (distance == 0) distance = 1;  // nothing, or a single point: any distance will do
  // Far from the origin, or near the least normal float, the step back must survive rounding to float.
  const glm::dvec3 reach = glm::max(glm::abs(bounds.empty() ? centre : bounds.low),
                                    glm::abs(bounds.empty() ? centre : bounds.high));
  distance = std::max(
      {distance, 1e-5 * std::max({reach.x, reach.y, reach.z}), 4.0 * std::numeric_limits<float>::min()});

  camera.target = clamp_to_float(centre);
  camera.position = clamp_to_float(centre + distance * toward_camera);
  // At the corner of float's range there is no room to step back: look from the other side.
  if (camera.position == camera.target) camera.position = clamp_to_float(centre - distance * toward_camera);
  return camera;
}

}  // namespace coppice
