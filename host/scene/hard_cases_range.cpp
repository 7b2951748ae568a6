#include <array>
#include <cmath>
#include <limits>

#include "scene/generators.h"
#include "scene/hard_case_makers.h"
#include "scene/shapes.h"

namespace coppice::hard {
namespace {

constexpr float INF = std::numeric_limits<float>::infinity();
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

// Spoils one coordinate of the triangle in turn: each corner, each axis, NaN and both infinities.
void spoil(Scene& scene, std::uint32_t triangle, std::uint32_t turn) {
  constexpr std::array values = {NOT_A_NUMBER, INF, -INF};
  scene.positions[triangle * 3 + turn % 3][static_cast<int>(turn / 3 % 3)] = values[turn / 9 % 3];
}

Scene spoilt(std::uint32_t triangle_count, std::uint64_t seed, std::uint32_t every) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    append_random_triangle(scene, 10.0f * random.in_cube(), 1, random);
  for (std::uint32_t i = 0; i < triangle_count; i += every) spoil(scene, i, i / every);
  return scene;
}

Scene terrain_at(std::uint32_t triangle_count, glm::vec3 place) {
  Scene scene = make_terrain(triangle_count);
  for (glm::vec3& position : scene.positions) position += place;
  return scene;
}

}  // namespace

Scene non_finite(std::uint32_t triangle_count, std::uint64_t seed) { return spoilt(triangle_count, seed, 3); }
Scene all_non_finite(std::uint32_t triangle_count, std::uint64_t seed) {
  return spoilt(triangle_count, seed, 1);
}

// Extents, areas and sums of coordinates overflow.
Scene huge(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    append_random_triangle(scene, 1.5e38f * random.in_cube(), i % 2 == 0 ? 1.5e38f : 1e36f, random);
  }
  return scene;
}

// The product of two coordinates is finite, of three it is not: areas are fine, determinants and volumes
// overflow.
Scene large(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    append_random_triangle(scene, 1e18f * random.in_cube(), 1e17f, random);
  return scene;
}

// Around the least normal float, 1.2e-38: areas underflow, and a device may flush some of the coordinates to
// zero.
Scene tiny(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    append_random_triangle(scene, 3e-38f * random.in_cube(), 1e-38f, random);
  return scene;
}

Scene mixed_scales(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float scale = i % 2 == 0 ? 1e-20f : 1e20f;
    append_random_triangle(scene, scale * random.in_cube(), 0.1f * scale, random);
  }
  return scene;
}

// Far from the origin, where an ulp is 2^-6 and neighbouring vertices of the mesh begin to coincide.
Scene far(std::uint32_t triangle_count, std::uint64_t) {
  return terrain_at(triangle_count, {148376, 1234, -223423});
}

// Where an ulp is 1 or, beyond 2^23, about to be: the hills become steps, many triangles lose their area.
Scene farther(std::uint32_t triangle_count, std::uint64_t) {
  return terrain_at(triangle_count, {1e7f, 1e7f, -1e7f});
}

// Coordinates -1, -0, 0 and 1: equal boxes whose bits differ, coplanar with the axes' planes.
Scene negative_zero(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  const auto corner = [&] {
    constexpr std::array values = {-1.0f, -0.0f, 0.0f, 1.0f};
    const float x = values[random.below(4)], y = values[random.below(4)], z = values[random.below(4)];
    return glm::vec3{x, y, z};
  };
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const glm::vec3 a = corner(), b = corner(), c = corner();
    append_triangle(scene, a, b, c, 0);
  }
  return scene;
}

}  // namespace coppice::hard
