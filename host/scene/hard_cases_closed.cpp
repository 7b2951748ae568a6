// Watertight meshes: vertices are shared by index, corners run counterclockwise seen from outside.
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/ext/vector_double2.hpp>
#include <glm/geometric.hpp>

#include "scene/hard_case_makers.h"
#include "scene/hard_cases.h"
#include "scene/shapes.h"

namespace coppice::hard {
namespace {

std::uint32_t append_vertex(Scene& scene, glm::vec3 position) {
  scene.positions.push_back(position);
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

// (cos, sin), exactly on the circle but for rounding.
glm::dvec2 on_circle(double turns) {
  return glm::normalize(glm::dvec2(turn_to_circle(static_cast<float>(turns))));
}

// Splits triangles, evenly spread over the mesh, into three around their centroid until there are
// `triangle_count` of them; that count is not below the present one and differs from it by an even number,
// less than twice the present one.
void split_up_to(Scene& scene, std::uint32_t triangle_count) {
  const std::size_t whole = scene.indices.size(), splits = (triangle_count - whole) / 2;
  for (std::size_t split = 0; split < splits; ++split) {
    glm::uvec3& triangle = scene.indices[split * whole / splits];
    const glm::uvec3 t = triangle;
    const auto& p = scene.positions;
    const std::uint32_t middle = append_vertex(scene, (p[t.x] + p[t.y] + p[t.z]) / 3.0f);
    triangle.z = middle;
    scene.indices.emplace_back(t.y, t.z, middle);
    scene.indices.emplace_back(t.z, t.x, middle);
  }
}

// Radius and height of a ring of vertices, where `fraction` goes from 0, the lowest ring, to 1.
using Profile = std::function<glm::dvec2(double fraction)>;

// A surface of revolution around the y axis: rings of vertices, and fans from a point on the axis at either
// end. r rings of s vertices are 2rs triangles.
Scene lathe(std::uint32_t triangle_count, std::uint32_t least_rings, double bottom, double top,
            const Profile& profile) {
  const auto rings = std::max(least_rings, static_cast<std::uint32_t>(std::sqrt(triangle_count / 4.0)));
  const std::uint32_t sides = triangle_count / (2 * rings);
  Scene scene;
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const glm::dvec2 at = profile(rings == 1 ? 0.5 : static_cast<double>(ring) / (rings - 1));
    for (std::uint32_t side = 0; side < sides; ++side) {
      const glm::dvec2 around = at.x * on_circle(static_cast<double>(side) / sides);
      append_vertex(scene, glm::vec3(around.x, at.y, around.y));
    }
  }
  const std::uint32_t lowest = append_vertex(scene, glm::vec3(0, bottom, 0));
  const std::uint32_t highest = append_vertex(scene, glm::vec3(0, top, 0));
  for (std::uint32_t side = 0; side < sides; ++side) {
    const std::uint32_t next = (side + 1) % sides, last = (rings - 1) * sides;
    scene.indices.emplace_back(lowest, side, next);
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::uint32_t a = ring * sides + side, b = ring * sides + next;
      scene.indices.emplace_back(a, a + sides, b);
      scene.indices.emplace_back(b, a + sides, b + sides);
    }
    scene.indices.emplace_back(highest, last + next, last + side);
  }
  split_up_to(scene, triangle_count);
  scene.material_index.assign(scene.indices.size(), 0);
  return scene;
}

Scene sphere_around(glm::vec3 centre, double radius, std::uint32_t triangle_count) {
  const std::uint32_t count = closed_triangle_count(triangle_count);
  // As many rings as lathe makes; the first and the last are a step away from the poles.
  const double steps = std::floor(std::sqrt(count / 4.0)) + 1;
  Scene scene = lathe(count, 1, -radius, radius, [&](double fraction) {
    const glm::dvec2 polar = on_circle((1 + fraction * (steps - 2)) / steps / 2);
    return radius * glm::dvec2(polar.y, -polar.x);
  });
  for (glm::vec3& position : scene.positions) position += centre;
  return scene;
}

// Place k, of 4 * side, on the way around the edge of a square grid, as (column, row).
glm::uvec2 on_border(std::uint32_t k, std::uint32_t side) {
  const std::uint32_t step = k % side;
  switch (k / side % 4) {
    case 0:
      return {step, 0};
    case 1:
      return {side, step};
    case 2:
      return {side - step, side};
    default:
      return {0, side - step};
  }
}

}  // namespace

std::uint32_t closed_triangle_count(std::uint32_t asked) {
  return std::max(asked + asked % 2, LEAST_CLOSED_TRIANGLES);
}

Scene make_pot(std::uint32_t triangle_count, glm::vec3 centre) {
  Scene scene = lathe(closed_triangle_count(triangle_count), 2, -4, 5, [](double fraction) {
    const double belly = fraction * (1 - fraction);
    return glm::dvec2(1.5 + 16 * belly * (1 - 0.5 * fraction), 8 * fraction - 4);
  });
  for (glm::vec3& position : scene.positions) position += centre;
  scene.indices.resize(triangle_count);
  scene.material_index.resize(triangle_count);
  return scene;
}

Scene sphere(std::uint32_t triangle_count, std::uint64_t) {
  return sphere_around(glm::vec3{0}, 10, triangle_count);
}

// Large enough for an ulp of 2^-6 to leave neighbouring vertices apart, up to about a million triangles.
Scene far_sphere(std::uint32_t triangle_count, std::uint64_t) {
  return sphere_around({148376, 1234, -223423}, 1024, triangle_count);
}

Scene cylinder(std::uint32_t triangle_count, std::uint64_t) {
  return lathe(closed_triangle_count(triangle_count), 2, -10, 10,
               [](double fraction) { return glm::dvec2(5, 20 * fraction - 10); });
}

// A floor of hills between -12 and -4, a flat ceiling at 8 that is a fan from its middle, and walls between
// the vertices on their borders: 2 s^2 + 8 s + 4 s triangles with s cells a side. The centre of the box is
// between -2 and 2, above the floor wherever that is.
Scene room(std::uint32_t triangle_count, std::uint64_t seed) {
  const std::uint32_t count = closed_triangle_count(triangle_count);
  std::uint32_t side = 1;
  while (2ull * (side + 1) * (side + 1) + 12ull * (side + 1) <= count) ++side;
  Scene scene;
  const auto ground = [&](glm::uvec2 at) { return at.y * (side + 1) + at.x; };
  for (std::uint32_t i = 0; i < (side + 1) * (side + 1); ++i) {
    const float x = 20.0f * static_cast<float>(i % (side + 1)) / static_cast<float>(side) - 10.0f;
    const float z = 20.0f * static_cast<float>(i / (side + 1)) / static_cast<float>(side) - 10.0f;
    const float hill = fractal_noise(0.3f * x, 0.3f * z, 6, static_cast<std::uint32_t>(seed));
    append_vertex(scene, {x, 2.0f * hill - 8.0f, z});
  }
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const std::uint32_t a = ground({i % side, i / side}), b = a + side + 1;
    scene.indices.emplace_back(a, a + 1, b);
    scene.indices.emplace_back(a + 1, b + 1, b);
  }
  const auto ceiling = static_cast<std::uint32_t>(scene.positions.size());
  for (std::uint32_t k = 0; k < 4 * side; ++k) {
    const glm::vec3 below = scene.positions[ground(on_border(k, side))];
    append_vertex(scene, {below.x, 8, below.z});
  }
  const std::uint32_t middle = append_vertex(scene, {0, 8, 0});
  for (std::uint32_t k = 0; k < 4 * side; ++k) {
    const std::uint32_t a = ground(on_border(k, side)), b = ground(on_border(k + 1, side));
    const std::uint32_t over_a = ceiling + k, over_b = ceiling + (k + 1) % (4 * side);
    scene.indices.emplace_back(b, a, over_a);
    scene.indices.emplace_back(b, over_a, over_b);
    scene.indices.emplace_back(over_b, over_a, middle);
  }
  split_up_to(scene, count);
  scene.material_index.assign(scene.indices.size(), 0);
  return scene;
}

}  // namespace coppice::hard
