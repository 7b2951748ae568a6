#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "scene/generators.h"
#include "scene/motion.h"
#include "scene/random.h"
#include "scene/shapes.h"

namespace coppice {
namespace {

// A grid of quads, two triangles each, exactly `triangle_count` of them; the last row may be incomplete.
// `place` takes (0, 0) to (1, 1).
template <class Place>
VertexRange append_grid(Scene& scene, std::uint32_t triangle_count, float columns_per_row,
                        std::uint32_t material, Place place) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  const std::uint32_t cells = triangle_count / 2 + triangle_count % 2;
  const auto columns = std::max(
      1u, static_cast<std::uint32_t>(std::sqrt(static_cast<double>(cells) * double{columns_per_row})));
  const std::uint32_t rows = (cells + columns - 1) / columns;
  for (std::uint32_t row = 0; row <= rows && triangle_count > 0; ++row) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      scene.positions.push_back(place(static_cast<float>(column) / static_cast<float>(columns),
                                      static_cast<float>(row) / static_cast<float>(rows)));
    }
  }
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const std::uint32_t a = first + i / 2 / columns * (columns + 1) + i / 2 % columns, b = a + columns + 1;
    scene.indices.push_back(i % 2 == 0 ? glm::uvec3{a, b, a + 1} : glm::uvec3{a + 1, b, b + 1});
    scene.material_index.push_back(material);
  }
  return {first, static_cast<std::uint32_t>(scene.positions.size()) - first};
}

glm::vec3 on_ball(float across, float along) {
  const glm::vec2 around = turn_to_circle(across), up = turn_to_circle(0.5f * along - 0.25f);
  return {up.x * around.x, up.y, up.x * around.y};
}

// The triangles of a ball, each with vertices of its own.
VertexRange append_shell(Scene& scene, std::uint32_t triangle_count, glm::vec3 centre, float radius,
                         std::uint32_t material) {
  Scene ball;
  append_grid(ball, triangle_count, 2.0f, material,
              [&](float x, float y) { return centre + radius * on_ball(x, y); });
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::uvec3& t : ball.indices)
    append_triangle(scene, ball.positions[t.x], ball.positions[t.y], ball.positions[t.z], material);
  return {first, 3 * triangle_count};
}

VertexRange append_swarm(Scene& scene, std::uint32_t triangle_count, glm::vec3 centre,
                         std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  const float size = 12.0f / std::sqrt(static_cast<float>(triangle_count) + 100.0f);
  Random random(5);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float turns = random.uniform(), distance = random.uniform(4.0f, 9.0f), up = random.uniform(-1, 5);
    const glm::vec2 circle = turn_to_circle(turns);
    const glm::vec3 at = centre + glm::vec3{distance * circle.x, up, distance * circle.y};
    const glm::vec3 b = at + size * random.in_cube();
    const glm::vec3 c = at + size * random.in_cube();
    append_triangle(scene, at, b, c, material);
  }
  return {first, 3 * triangle_count};
}

}  // namespace

Scene make_moving(std::uint32_t triangle_count) {
  enum : std::uint32_t { WATER, COLUMN, SHELL, SWARM };
  Scene scene;
  scene.name = "moving:" + std::to_string(triangle_count);
  scene.materials = {coloured("water", {0.16f, 0.42f, 0.56f}), coloured("column", {0.82f, 0.62f, 0.34f}),
                     coloured("shell", {0.78f, 0.26f, 0.22f}), coloured("swarm", {0.90f, 0.88f, 0.62f})};
  const std::uint32_t fifth = triangle_count / 5;
  const glm::vec3 column_foot{-3, -0.5f, 0}, shell_centre{6, 3.5f, -2};
  const VertexRange water = append_grid(scene, triangle_count - 3 * fifth, 1.0f, WATER, [](float x, float y) {
    return glm::vec3{44 * (x - 0.5f), 0, 44 * (y - 0.5f)};
  });
  const VertexRange column = append_grid(scene, fifth, 1.0f, COLUMN, [&](float x, float y) {
    const glm::vec2 circle = turn_to_circle(x);
    const float radius = 1.9f - 0.7f * y + 0.25f * turn_to_circle(5 * x).x;  // fluted
    return column_foot + glm::vec3{radius * circle.x, 8 * y, radius * circle.y};
  });
  const VertexRange shell = append_shell(scene, fifth, shell_centre, 2.4f, SHELL);
  const VertexRange swarm = append_swarm(scene, fifth, column_foot + glm::vec3{0, 3, 0}, SWARM);

  const auto motion = std::make_shared<Motion>();
  motion->rest = scene.positions;
  motion->deformations = {{water, DeformKind::wave, 1, {0, 0, 0}, 16, 0.03f, 4},
                          {column, DeformKind::twist, 1, column_foot, 8, 0.4f, 4},
                          {shell, DeformKind::explode, 3, shell_centre, 2.4f, 2.0f, 4},
                          {swarm, DeformKind::swarm, 3, column_foot + glm::vec3{0, 3, 0}, 9, 0.06f, 4}};
  motion->duration_seconds = 4;
  scene.motion = motion;
  scene.positions = positions_at(*motion, 0);
  scene.camera = Camera{
      .position = {4, 8.5f, 19}, .target = {0.8f, 2.4f, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = 42};
  scene.light.direction = glm::normalize(glm::vec3{0.5f, 0.8f, 0.45f});
  scene.light.radiance = {1.1f, 1.05f, 0.95f};
  return scene;
}

}  // namespace coppice
