#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "scene/bounds.h"
#include "scene/motion.h"

namespace coppice {
namespace {

// The rotation that turns the axis `up` into +y. Its columns are the images of x, y and z.
glm::mat3 turn_of(std::string_view up) {
  const float sign = up.starts_with('-') ? -1.0f : 1.0f;
  switch (up.back()) {
    case 'x':
      return {glm::vec3{0, sign, 0}, glm::vec3{-sign, 0, 0}, glm::vec3{0, 0, 1}};
    case 'z':
      return {glm::vec3{1, 0, 0}, glm::vec3{0, 0, -sign}, glm::vec3{0, sign, 0}};
    default:
      return {glm::vec3{1, 0, 0}, glm::vec3{0, sign, 0}, glm::vec3{0, 0, sign}};
  }
}

glm::dvec3 scaled(glm::dvec3 point, int exponent) {
  return {std::ldexp(point.x, exponent), std::ldexp(point.y, exponent), std::ldexp(point.z, exponent)};
}

void move_to_scene(Scene& scene, const glm::dmat4& step) {
  if (!scene.motion) return;
  const auto motion = std::make_shared<Motion>(*scene.motion);
  motion->to_scene = step * motion->to_scene;
  scene.motion = motion;
}

// What is thin over a long way is as thin over as many shorter units.
void scale_fog(Fog& fog, int exponent) {
  const auto times = [](float x, int power) { return static_cast<float>(std::ldexp(double{x}, power)); };
  fog.density = times(fog.density, -exponent);
  if (!fog.box) return;
  for (int axis = 0; axis < 3; ++axis) {
    fog.box->min[axis] = times(fog.box->min[axis], exponent);
    fog.box->max[axis] = times(fog.box->max[axis], exponent);
  }
}

}  // namespace

void set_lights(Scene& scene, std::vector<Light> lights) {
  const auto first = std::ranges::find(lights, false, &Light::is_point);
  scene.light.radiance = glm::vec3(0);
  if (first != lights.end()) {
    scene.light = {first->place, first->radiance, first->shadows};
    scene.light_origin = first->origin;
    lights.erase(first);
  }
  scene.more_lights = std::move(lights);
}

std::uint32_t count_inactive(const Scene& scene) {
  return static_cast<std::uint32_t>(std::count_if(scene.indices.begin(), scene.indices.end(),
                                                  [&](glm::uvec3 t) { return !is_active(scene, t); }));
}

FogBox fog_box(const glm::vec3& corner, const glm::vec3& opposite) {
  return {glm::min(corner, opposite), glm::max(corner, opposite)};
}

void bring_into_range(Scene& scene) {
  const double largest = active_bounds(scene).reach();
  if (largest == 0 || (largest >= 0x1p-30 && largest <= 0x1p30)) return;
  const int exponent = 30 - std::ilogb(largest);
  const auto scale = [exponent](float x) { return static_cast<float>(std::ldexp(double{x}, exponent)); };
  const auto scale_point = [&](glm::vec3& p) { p = {scale(p.x), scale(p.y), scale(p.z)}; };
  if (scene.instances.empty()) std::ranges::for_each(scene.positions, scale_point);
  for (Instance& instance : scene.instances) {
    for (int column = 0; column < 4; ++column) scale_point(instance.transform[column]);
  }
  if (scene.camera) {
    scale_point(scene.camera->position);
    scale_point(scene.camera->target);
  }
  scene.lens.aperture = scale(scene.lens.aperture);
  scene.lens.focus = scale(scene.lens.focus);
  if (scene.occlusion) scene.occlusion->distance = scale(scene.occlusion->distance);
  if (scene.fog) scale_fog(*scene.fog, exponent);
  for (Light& light : scene.more_lights) {
    if (!light.is_point) continue;
    scale_point(light.place);
    light.distance = scale(light.distance);
  }
  scene.scale_exponent += exponent;
  const double factor = std::ldexp(1.0, exponent);
  move_to_scene(scene, glm::dmat4(glm::dmat3(factor)));
}

void stand_up(Scene& scene, std::string_view up) {
  if (up == "y") return;
  const glm::mat3 turn = turn_of(up);
  if (scene.instances.empty()) {
    for (glm::vec3& position : scene.positions) position = turn * position;
    for (glm::vec3& normal : scene.normals) normal = turn * normal;
  }
  for (Instance& instance : scene.instances) instance.transform = turn * instance.transform;
  for (Light& light : scene.more_lights) light.place = turn * light.place;
  if (scene.fog && scene.fog->box) {
    FogBox& box = *scene.fog->box;
    box = fog_box(turn * box.min, turn * box.max);
  }
  scene.turn = turn * scene.turn;
  move_to_scene(scene, glm::dmat4(glm::dmat3(turn)));
  scene.camera.reset();
  scene.lens = {};
}

glm::dvec3 direction_to_scene(const Scene& scene, glm::dvec3 direction) {
  return glm::dmat3{scene.turn} * direction;
}

glm::dvec3 direction_to_file(const Scene& scene, glm::dvec3 direction) {
  return glm::transpose(glm::dmat3{scene.turn}) * direction;
}

glm::dvec3 to_scene(const Scene& scene, glm::dvec3 point) {
  return scaled(direction_to_scene(scene, point - scene.offset), scene.scale_exponent);
}

glm::dvec3 to_file(const Scene& scene, glm::dvec3 point) {
  return direction_to_file(scene, scaled(point, -scene.scale_exponent)) + scene.offset;
}

}  // namespace coppice
