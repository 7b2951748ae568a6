#pragma once

#include <cstdint>
#include <vector>

#include "interface/types.h"
#include "scene/random.h"
#include "scene/scene.h"

namespace coppice {

// Triangles of edge length about 0.1 in the cube [-1, 1)^3.
inline std::vector<Triangle> random_soup(std::uint32_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Triangle> soup;
  for (std::uint32_t i = 0; i < count; ++i) {
    const vec3 a = random.in_cube();
    const vec3 to_b = random.in_cube() * 0.1f;
    const vec3 to_c = random.in_cube() * 0.1f;
    soup.push_back({a, a + to_b, a + to_c});
  }
  return soup;
}

// One flat triangle in the plane of each x.
inline std::vector<Triangle> slices_at(const std::vector<float>& xs) {
  std::vector<Triangle> slices;
  for (const float x : xs) slices.push_back({vec3(x, 0, 0), vec3(x, 1, 0), vec3(x, 0, 1)});
  return slices;
}

inline std::vector<Triangle> triangles_of(const Scene& scene) {
  std::vector<Triangle> triangles;
  for (const glm::uvec3& corners : scene.indices) {
    triangles.push_back({scene.positions[corners.x], scene.positions[corners.y], scene.positions[corners.z]});
  }
  return triangles;
}

}  // namespace coppice
