#include "scene/hard_case_makers.h"
#include "scene/shapes.h"

namespace coppice::hard {

// Every distance and every Morton code ties.
Scene coincident(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    append_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  return scene;
}

// The ties of `coincident` in the midst of a scene that has none; the copies lie in the middle of the others.
Scene coincident_and_random(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    if (i % 2 == 0) {
      append_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    } else {
      append_random_triangle(scene, 10.0f * random.in_cube(), 0.5f, random);
    }
  }
  return scene;
}

// Boxes around one centre: all Morton codes tie, no distance does.
Scene nested(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float s = static_cast<float>(i + 1) * 0x1p-10f;
    append_triangle(scene, {-s, -s, -s}, {s, -s, s}, {0, s, 0}, 0);
  }
  return scene;
}

// Triangles whose boxes and whose corners both have the origin for their centre: each axis has the
// coordinates -s, 0 and s. By turns in the four planes x + y + z = 0 with signs, so that they also cross.
Scene nested_shells(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float s = static_cast<float>(i / 4 + 1) * 0x1p-10f;
    const float x = i % 4 == 1 ? -s : s, y = i % 4 == 2 ? -s : s, z = i % 4 == 3 ? -s : s;
    append_triangle(scene, {-x, 0, z}, {0, y, -z}, {x, -y, 0}, 0);
  }
  return scene;
}

// One outlier stretches the grid until all the others fall into one cell of it.
Scene one_cell(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i + 1 < triangle_count; ++i) {
    append_random_triangle(scene, glm::vec3{1e-4f} + 5e-5f * random.in_cube(), 1e-6f, random);
  }
  if (triangle_count > 0) append_random_triangle(scene, glm::vec3{1e4f}, 1, random);
  return scene;
}

// The teapot in the stadium. Of the 2^10 cells an axis that a code of 30 bits can name, the stadium's floor
// of 2^13 uses half: cells have a side of 16, the floor's corner is at a corner of the grid, and the pot lies
// within the cell from 0 to 16. So does the centre of one of the stadium's two triangles.
Scene stadium(std::uint32_t triangle_count, std::uint64_t) {
  const std::uint32_t pot_triangles = triangle_count < 2 ? 0 : triangle_count - 2;
  Scene scene = make_pot(pot_triangles, glm::vec3{8});
  constexpr float side = 4096;
  if (triangle_count > 0) append_triangle(scene, {-side, 0, -side}, {-side, 0, side}, {side, 0, -side}, 0);
  if (triangle_count > 1) append_triangle(scene, {side, 0, -side}, {-side, 0, side}, {side, 512, side}, 0);
  return scene;
}

}  // namespace coppice::hard
