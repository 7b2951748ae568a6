#include <array>
#include <cmath>
#include <vector>

#include "scene/generators.h"
#include "scene/hard_case_makers.h"
#include "scene/shapes.h"

namespace coppice::hard {

Scene planar_grid(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = make_terrain(triangle_count);
  for (glm::vec3& position : scene.positions) position.y = 0;
  scene.materials = {Material{}};
  scene.material_index.assign(triangle_count, 0);
  return scene;
}

// A height field over cells of side 1/16 with random heights: rays can go exactly through its vertices and
// along its edges. Two triangles a cell, the last row of cells may be incomplete; neighbours share vertices
// by index, and no vertex lies on an edge of another triangle.
Scene dyadic_grid(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene;
  const std::uint32_t cells = triangle_count / 2 + triangle_count % 2;
  const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(cells))));
  const std::uint32_t rows = cells == 0 ? 0 : (cells + columns - 1) / columns;
  Random random(seed);
  for (std::uint32_t i = 0; cells > 0 && i < (columns + 1) * (rows + 1); ++i) {
    const float x = static_cast<float>(i % (columns + 1)) / 16,
                z = static_cast<float>(i / (columns + 1)) / 16;
    scene.positions.emplace_back(x, static_cast<float>(random.below(16)) / 256, z);
  }
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const std::uint32_t a = i / 2 / columns * (columns + 1) + i / 2 % columns, b = a + columns + 1;
    scene.indices.push_back(i % 2 == 0 ? glm::uvec3{a, b, a + 1} : glm::uvec3{a + 1, b, b + 1});
  }
  scene.material_index.assign(triangle_count, 0);
  return scene;
}

// Degenerate triangles, by turns a point and a segment: legal, in the tree, never hit.
Scene points(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const glm::vec3 a = 10.0f * random.in_cube();
    const glm::vec3 b = i % 2 == 0 ? a : a + random.in_cube();
    append_triangle(scene, a, b, a, 0);
  }
  return scene;
}

// The third corner is within an ulp or so of the middle of the long edge: some have no area at all.
Scene needles(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const glm::vec3 a = 10.0f * random.in_cube();
    const glm::vec3 b = a + 10.0f * random.direction();
    append_triangle(scene, a, b, 0.5f * (a + b) + 1e-6f * random.in_cube(), 0);
  }
  return scene;
}

// The box of each is almost the whole scene, whose volume it almost leaves empty.
Scene diagonals(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const glm::vec3 corner{100, i % 4 & 1 ? -100 : 100, i % 4 & 2 ? -100 : 100};
    const glm::vec3 a = random.in_cube() - corner;
    const glm::vec3 b = random.in_cube() + corner;
    append_triangle(scene, a, b, b + 0.01f * random.in_cube(), 0);
  }
  return scene;
}

// The huge one comes first, and is an outlier of every node that it is in.
Scene huge_over_tiny(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  if (triangle_count > 0) append_triangle(scene, {-300, 1, -300}, {300, 1, -300}, {0, 1, 600}, 0);
  for (std::uint32_t i = 1; i < triangle_count; ++i) {
    const glm::vec3 centre = 50.0f * random.in_cube();
    append_random_triangle(scene, {centre.x, 0, centre.z}, 0.01f, random);
  }
  return scene;
}

// Pair i shares the edge from (0, 0, i) to (1, 0, i), by index. By turns both lie in the plane z = i, or the
// second one stands at a right angle to it. A last one without a partner may be alone.
Scene edge_pairs(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; i += 2) {
    const auto z = static_cast<float>(i / 2);
    append_triangle(scene, {0, 0, z}, {1, 0, z}, {0.5f, 1, z}, 0);
    if (i + 1 == triangle_count) break;
    const glm::uvec3 first = scene.indices.back();
    const auto other = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.push_back(i / 2 % 2 == 0 ? glm::vec3{0.5f, -1, z} : glm::vec3{0.5f, 0, z - 0.5f});
    scene.indices.emplace_back(first.y, first.x, other);
    scene.material_index.push_back(0);
  }
  return scene;
}

// Of every five triangles one is a point by index, three are segments, with the repeated vertex in each of
// the three places, and one is whole. Vertices belong to several triangles.
Scene repeated_indices(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved_scene(triangle_count);
  Random random(seed);
  const std::uint32_t vertex_count = triangle_count / 2 + 3;
  for (std::uint32_t i = 0; i < vertex_count; ++i) scene.positions.push_back(10.0f * random.in_cube());
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const std::uint32_t a = random.below(vertex_count), b = (a + 1) % vertex_count,
                        c = (a + 2) % vertex_count;
    const std::array kinds = {glm::uvec3{a, a, a}, glm::uvec3{a, a, b}, glm::uvec3{a, b, a},
                              glm::uvec3{b, a, a}, glm::uvec3{a, b, c}};
    scene.indices.push_back(kinds[i % 5]);
  }
  scene.material_index.assign(triangle_count, 0);
  return scene;
}

// A terrain as files without an index buffer give it: each triangle has three vertices of its own.
Scene repeated_positions(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = make_terrain(triangle_count);
  std::vector<glm::vec3> positions;
  positions.reserve(std::size_t{triangle_count} * 3);
  for (glm::uvec3& triangle : scene.indices) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (int corner = 0; corner < 3; ++corner) positions.push_back(scene.positions[triangle[corner]]);
    triangle = {first, first + 1, first + 2};
  }
  scene.positions = std::move(positions);
  return scene;
}

}  // namespace coppice::hard
