#include "scene/generators.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "scene/random.h"
#include "scene/shapes.h"

namespace coppice {
namespace {

glm::vec3 point_in(glm::vec3 centre, float radius, Random& random) {
  return centre + radius * random.in_cube();
}

// One triangle of the kinds that a scene mixes: mostly small and round, some slivers, a few that span the
// cluster.
void append_scattered(Scene& scene, glm::vec3 centre, float radius, Random& random, std::uint32_t material) {
  const glm::vec3 a = point_in(centre, radius, random);
  const std::uint32_t kind = random.below(100);
  if (kind < 88) {
    const float size = radius * 0.03f;
    const glm::vec3 b = point_in(a, size, random);
    return append_triangle(scene, a, b, point_in(a, size, random), material);
  }
  if (kind < 98) {  // long and thin
    // Two draws in one expression would come in an order that is the compiler's.
    const glm::vec3 direction = random.direction();
    const glm::vec3 b = a + radius * random.uniform(0.1f, 0.8f) * direction;
    return append_triangle(scene, a, b, point_in(b, radius * 0.002f, random), material);
  }
  const glm::vec3 b = point_in(centre, radius, random);
  append_triangle(scene, a, b, point_in(centre, radius, random), material);
}

}  // namespace

Scene make_scatter(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene;
  scene.name = "scatter:" + std::to_string(triangle_count);
  scene.materials = {coloured("clay", {0.72f, 0.42f, 0.30f}), coloured("sand", {0.80f, 0.70f, 0.48f}),
                     coloured("slate", {0.36f, 0.42f, 0.50f}), coloured("moss", {0.38f, 0.52f, 0.28f})};
  scene.positions.reserve(std::size_t{triangle_count} * 3);
  scene.indices.reserve(triangle_count);
  scene.material_index.reserve(triangle_count);
  Random random(seed);
  while (scene.indices.size() < triangle_count) {
    // Radius 100 / 4^k, so that clusters, and the triangles in them, span more than four orders of magnitude.
    float radius = 100;
    for (std::uint32_t k = random.below(8); k > 0; --k) radius *= 0.25f;
    const glm::vec3 centre = point_in(glm::vec3{0}, 100, random);
    const auto material = random.below(static_cast<std::uint32_t>(scene.materials.size()));
    for (std::uint32_t left = 64 + random.below(4096); left > 0 && scene.indices.size() < triangle_count;
         --left) {
      append_scattered(scene, centre, radius, random, material);
    }
  }
  return scene;
}

Scene make_terrain(std::uint32_t triangle_count) {
  Scene scene;
  scene.name = "terrain:" + std::to_string(triangle_count);
  scene.materials = {coloured("meadow", {0.34f, 0.47f, 0.20f}), coloured("rock", {0.46f, 0.43f, 0.40f}),
                     coloured("snow", {0.90f, 0.91f, 0.93f})};
  const std::uint32_t cell_count = triangle_count / 2 + triangle_count % 2;
  auto columns = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(cell_count)));
  columns = columns == 0 ? 1 : columns;
  const std::uint32_t rows = (cell_count + columns - 1) / columns;

  const float cell = 100.0f / static_cast<float>(columns);
  scene.positions.reserve(std::size_t{columns + 1} * (rows + 1));
  for (std::uint32_t row = 0; row <= rows && triangle_count > 0; ++row) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      const float x = static_cast<float>(column) * cell - 50.0f, z = static_cast<float>(row) * cell - 50.0f;
      const float height = 9.0f * fractal_noise(0.05f * x, 0.05f * z, 7, 7);
      scene.positions.emplace_back(x, height, z);
    }
  }
  scene.indices.reserve(triangle_count);
  scene.material_index.reserve(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const std::uint32_t a = i / 2 / columns * (columns + 1) + i / 2 % columns, b = a + columns + 1;
    const glm::uvec3 triangle = i % 2 == 0 ? glm::uvec3{a, b, a + 1} : glm::uvec3{a + 1, b, b + 1};
    const float height = scene.positions[triangle.x].y;
    scene.indices.push_back(triangle);
    scene.material_index.push_back(height > 6.0f ? 2u : height > 1.5f ? 1u : 0u);
  }
  return scene;
}

}  // namespace coppice
