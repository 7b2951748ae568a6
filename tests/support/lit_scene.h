#pragma once

#include "scene/scene.h"
#include "support/test_device.h"

namespace coppice {

inline void add_triangle(Scene& scene, const Triangle& t) {
  const auto first = static_cast<uint>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {t.a, t.b, t.c});
  scene.indices.push_back({first, first + 1, first + 2});
  scene.material_index.push_back(0);
}

inline void add_quad(Scene& scene, vec3 corner, vec3 a, vec3 b) {
  add_triangle(scene, {corner, corner + a, corner + a + b});
  add_triangle(scene, {corner, corner + a + b, corner + b});
}

// Random triangles over a plane: there is much for light to be blocked by.
inline Scene triangles_over_plane(std::uint32_t count) {
  Scene scene;
  add_quad(scene, {-5, -0.5f, -5}, {0, 0, 10}, {10, 0, 0});
  for (const Triangle& t : random_triangles(count, 3, 0.3f)) add_triangle(scene, t);
  scene.camera = Camera{.position = {2, 3, 4}, .target = {0.5f, 0, 0.5f}};
  return scene;
}

}  // namespace coppice
