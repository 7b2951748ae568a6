#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <vector>

#include "interface/trace.h"
#include "scene/random.h"

namespace coppice {

// Rays without an end, from points in and around the box of `triangles` (one and a half times its size) in
// all directions. The triangles are active.
inline std::vector<Ray> rays_around(std::span<const Triangle> triangles, std::uint32_t count,
                                    std::uint64_t seed) {
  vec3 low = triangles[0].a, high = low;
  for (const Triangle& triangle : triangles) {
    low = glm::min(glm::min(low, triangle.a), glm::min(triangle.b, triangle.c));
    high = glm::max(glm::max(high, triangle.a), glm::max(triangle.b, triangle.c));
  }
  const vec3 centre = 0.5f * (low + high), half_extent = 0.5f * (high - low);
  Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    const vec3 origin = centre + 1.5f * half_extent * random.in_cube();
    ray = {origin, 0.0f, random.direction(), std::numeric_limits<float>::infinity()};
  }
  return rays;
}

// Rays without an end from random points around, through a point of an edge of a random triangle, every
// fourth through a corner: up to the rounding of the direction.
inline std::vector<Ray> rays_at_edges(std::span<const Triangle> triangles, std::uint32_t count,
                                      std::uint64_t seed) {
  std::vector<Ray> rays = rays_around(triangles, count, seed);
  Random random(seed + 1);
  for (Ray& ray : rays) {
    const Triangle& triangle = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const float s = random.below(4) == 0 ? 0.0f : random.uniform();
    ray.direction = glm::mix(triangle.a, triangle.b, s) - ray.origin;
  }
  return rays;
}

}  // namespace coppice
