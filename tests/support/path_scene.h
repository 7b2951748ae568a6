#pragma once

#include "support/lit_scene.h"

namespace coppice {

// Scenes whose radiance is known, with no light but what emits.

inline Scene dark_scene() {
  Scene scene;
  scene.light.radiance = scene.ambient_light = vec3(0);
  scene.materials.clear();
  return scene;
}

inline void add_surface(Scene& scene, vec3 corner, vec3 a, vec3 b, std::uint32_t material) {
  add_quad(scene, corner, a, b);
  scene.material_index.end()[-1] = scene.material_index.end()[-2] = material;
}

inline std::uint32_t add_material(Scene& scene, vec3 diffuse, vec3 emission = vec3(0)) {
  Material material;
  material.diffuse = diffuse;
  material.emission = emission;
  scene.materials.push_back(material);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

inline std::uint32_t add_glass(Scene& scene) {
  const std::uint32_t index = add_material(scene, vec3(0));
  Material& glass = scene.materials[index];
  glass.name = "glass";
  glass.specular = vec3(1);
  glass.index_of_refraction = 1.5f;
  glass.illum = 7;
  return index;
}

// The sides of a box, outwards from `low` to `high`, one material each.
inline void add_box(Scene& scene, vec3 low, vec3 high, std::uint32_t material) {
  const vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
  add_surface(scene, low, y, x, material);
  add_surface(scene, low + z, x, y, material);
  add_surface(scene, low, x, z, material);
  add_surface(scene, low + y, z, x, material);
  add_surface(scene, low, z, y, material);
  add_surface(scene, low + x, y, z, material);
}

inline Scene furnace(float albedo, float emission) {
  Scene scene = dark_scene();
  add_box(scene, vec3(-1), vec3(1), add_material(scene, vec3(albedo), vec3(emission)));
  scene.camera = Camera{.position = {0.3f, 0.2f, 0.5f}, .target = {-0.4f, 0, -1}};
  scene.global_illumination = true;
  scene.bounces = 64;
  return scene;
}

// A square of side 2 that emits 3, at height 2 over a plane of albedo 0.8, of which the camera sees the point
// below its middle; half of it may be covered for that point.
inline Scene square_light_over_plane(bool covered) {
  Scene scene = dark_scene();
  add_surface(scene, {-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, add_material(scene, vec3(0.8f)));
  const std::uint32_t lamp = add_material(scene, vec3(0), vec3(3));
  add_surface(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
  if (covered) add_surface(scene, {0, 1, -5}, {5, 0, 0}, {0, 0, 10}, add_material(scene, vec3(0)));
  scene.camera = Camera{.position = {-0.5f, 0.2f, 0}, .target = {0, 0, 0}, .vertical_fov_degrees = 0.25f};
  return scene;
}

// A slab of glass from z = 0 to z = -1, and behind it a wall; the camera looks along (tangent, 0, -1) at
// (0, 0, 0).
inline Scene slab_before_wall(float tangent) {
  Scene scene = dark_scene();
  add_box(scene, {-60, -60, -1}, {60, 60, 0}, add_glass(scene));
  scene.camera = Camera{.position = {-4 * tangent, 0, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 0.1f};
  return scene;
}

inline Scene glass_slab(float tangent) {
  Scene scene = slab_before_wall(tangent);
  add_surface(scene, {-90, -90, -2}, {180, 0, 0}, {0, 180, 0}, add_material(scene, vec3(0), vec3(1)));
  return scene;
}

// The wall emits only left of where a ray without glass meets it less `shift`.
inline Scene glass_slab_before_edge(float tangent, float shift) {
  Scene scene = slab_before_wall(tangent);
  const float edge = 2 * tangent - shift;
  add_surface(scene, {edge, -90, -2}, {90, 0, 0}, {0, 180, 0}, add_material(scene, vec3(0), vec3(1)));
  return scene;
}

// A mirror, in which the camera sees a wall of radiance 2.
inline Scene mirror_scene(float colour) {
  Scene scene = dark_scene();
  const std::uint32_t mirror = add_material(scene, vec3(0));
  scene.materials[mirror].specular = vec3(colour);
  scene.materials[mirror].illum = 3;
  add_surface(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, mirror);
  add_surface(scene, {-50, -50, -9}, {100, 0, 0}, {0, 100, 0}, add_material(scene, vec3(0), vec3(2)));
  scene.camera = Camera{.position = {0, 2, 2}, .target = {0, 0, 0}, .vertical_fov_degrees = 5};
  return scene;
}

// A metal of that roughness below a small lamp, lit by light samples and by bounces.
inline Scene glossy_scene(float roughness) {
  Scene scene = dark_scene();
  const std::uint32_t metal = add_material(scene, vec3(0.9f));
  scene.materials[metal].roughness = roughness;
  scene.materials[metal].metallic = 1;
  add_surface(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, metal);
  add_surface(scene, {-1, 2, -2}, {2, 0, 0}, {0, 0, 2}, add_material(scene, vec3(0), vec3(2)));
  scene.camera = Camera{.position = {0, 2, 2}, .target = {0, 0, 0}, .vertical_fov_degrees = 20};
  scene.bounces = 1;
  return scene;
}

// All lobes, a lamp, a point of light, shadows: what a path may meet.
inline Scene room_of_all_surfaces() {
  Scene scene = dark_scene();
  const std::uint32_t wall = add_material(scene, {0.7f, 0.6f, 0.5f});
  add_box(scene, {-2, 0, -2}, {2, 3, 2}, wall);
  add_surface(scene, {-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, vec3(0), {9, 8, 7}));
  const std::uint32_t metal = add_material(scene, {0.9f, 0.7f, 0.3f});
  scene.materials[metal].roughness = 0.3f;
  scene.materials[metal].metallic = 0.8f;
  add_box(scene, {-1.2f, 0.01f, -1.2f}, {-0.4f, 1.2f, -0.2f}, metal);
  const std::uint32_t glass = add_glass(scene);
  scene.materials[glass].filter = {0.9f, 1, 0.8f};
  add_box(scene, {0.2f, 0.01f, -0.6f}, {1.2f, 0.8f, 0.4f}, glass);
  const std::uint32_t mirror = add_material(scene, vec3(0.1f));
  scene.materials[mirror].specular = vec3(0.8f);
  scene.materials[mirror].illum = 3;
  add_surface(scene, {-1.9f, 0.3f, 1}, {0, 2, 0}, {0.3f, 0, -2}, mirror);
  scene.more_lights.push_back(
      {.is_point = true, .place = {1, 2.5f, 1}, .radiance = vec3(0.3f), .shadows = true, .origin = "lamp"});
  scene.more_lights.push_back(
      {.is_point = true, .place = {-1, 2, 1}, .radiance = vec3(0.2f), .origin = "free"});
  scene.camera =
      Camera{.position = {0.2f, 1.4f, 1.8f}, .target = {-0.1f, 0.8f, -1}, .vertical_fov_degrees = 80};
  scene.global_illumination = true;
  return scene;
}

}  // namespace coppice
