#include "scene/shapes.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace coppice {
namespace {

// Any unit vector at a right angle to `axis`, which is of unit length.
glm::vec3 perpendicular(glm::vec3 axis) {
  const glm::vec3 other = std::abs(axis.x) < 0.6f ? glm::vec3{1, 0, 0} : glm::vec3{0, 0, 1};
  return glm::normalize(glm::cross(axis, other));
}

std::uint32_t append_position(Scene& scene, glm::vec3 position) {
  scene.positions.push_back(position);
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

void append_indices(Scene& scene, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material) {
  scene.indices.emplace_back(a, b, c);
  scene.material_index.push_back(material);
}

// A hash of a lattice point, in [-1, 1).
float lattice(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(y) * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  h ^= h >> 16;
  return static_cast<float>(h >> 8) * 0x1p-23f - 1.0f;
}

float smooth(float t) { return t * t * (3.0f - 2.0f * t); }

// Splits a spherical triangle into four, `depth` times, and appends the pieces as `place` puts them.
template <class Place>
void append_patch(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c, int depth, const Place& place,
                  std::uint32_t material) {
  if (depth == 0) return append_triangle(scene, place(a), place(b), place(c), material);
  const glm::vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
  append_patch(scene, a, ab, ca, depth - 1, place, material);
  append_patch(scene, ab, b, bc, depth - 1, place, material);
  append_patch(scene, ca, bc, c, depth - 1, place, material);
  append_patch(scene, ab, bc, ca, depth - 1, place, material);
}

}  // namespace

Material coloured(std::string name, glm::vec3 colour) {
  Material material;
  material.name = std::move(name);
  material.diffuse = colour;
  return material;
}

void append_triangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c, std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {a, b, c});
  append_indices(scene, first, first + 1, first + 2, material);
}

void append_tube(Scene& scene, std::span<const glm::vec3> path, std::span<const float> radius,
                 std::uint32_t sides, float roughness, Random& random, std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  glm::vec3 right = perpendicular(glm::normalize(path[1] - path[0]));
  for (std::size_t ring = 0; ring < path.size(); ++ring) {
    const glm::vec3 before = path[ring == 0 ? 0 : ring - 1];
    const glm::vec3 after = path[ring + 1 == path.size() ? ring : ring + 1];
    const glm::vec3 axis = glm::normalize(after - before);
    right = glm::normalize(right -
                           axis * glm::dot(right, axis));  // carried along, so that the tube does not twist
    const glm::vec3 up = glm::cross(axis, right);
    for (std::uint32_t side = 0; side < sides; ++side) {
      const glm::vec2 on_circle = turn_to_circle(static_cast<float>(side) / static_cast<float>(sides));
      const float r = radius[ring] * (1.0f + roughness * random.uniform(-1, 1));
      append_position(scene, path[ring] + r * (on_circle.x * right + on_circle.y * up));
    }
  }
  for (std::uint32_t ring = 0; ring + 1 < path.size(); ++ring) {
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = first + ring * sides + side, b = first + ring * sides + (side + 1) % sides;
      append_indices(scene, a, b, b + sides, material);
      append_indices(scene, a, b + sides, a + sides, material);
    }
  }
}

void append_disc(Scene& scene, glm::vec3 centre, glm::vec3 normal, float radius, std::uint32_t sides,
                 std::uint32_t material) {
  const glm::vec3 right = perpendicular(normal), up = glm::cross(normal, right);
  const std::uint32_t middle = append_position(scene, centre);
  for (std::uint32_t side = 0; side < sides; ++side) {
    const glm::vec2 on_circle = turn_to_circle(static_cast<float>(side) / static_cast<float>(sides));
    append_position(scene, centre + radius * (on_circle.x * right + on_circle.y * up));
  }
  for (std::uint32_t side = 0; side < sides; ++side) {
    append_indices(scene, middle, middle + 1 + side, middle + 1 + (side + 1) % sides, material);
  }
}

void append_rock(Scene& scene, glm::vec3 centre, glm::vec3 half_extent, Random& random,
                 std::uint32_t material) {
  const std::uint32_t seed = random.next();
  const auto place = [&](glm::vec3 p) {
    const float bump = 0.22f * fractal_noise(1.7f * p.x + 3.0f * p.y, 1.7f * p.z - 2.0f * p.y, 3, seed);
    return centre + half_extent * p * (1.0f + bump);
  };
  for (int octant = 0; octant < 8; ++octant) {
    const glm::vec3 x{octant & 1 ? -1 : 1, 0, 0}, y{0, octant & 2 ? -1 : 1, 0}, z{0, 0, octant & 4 ? -1 : 1};
    const bool mirrored = x.x * y.y * z.z < 0;
    append_patch(scene, x, mirrored ? z : y, mirrored ? y : z, 3, place, material);
  }
}

void append_leaf(Scene& scene, glm::vec3 stem, glm::vec3 forward, glm::vec3 sideways,
                 std::uint32_t material) {
  const glm::vec3 tip = stem + forward;
  const glm::vec3 fold = 0.3f * glm::cross(glm::normalize(forward), sideways);
  const glm::vec3 middle = stem + 0.45f * forward;
  append_triangle(scene, stem, middle + sideways + fold, tip, material);
  append_triangle(scene, stem, tip, middle - sideways + fold, material);
}

float value_noise(float x, float y, std::uint32_t seed) {
  const float cell_x = std::floor(x), cell_y = std::floor(y);
  const auto i = static_cast<std::int32_t>(cell_x), j = static_cast<std::int32_t>(cell_y);
  const float u = smooth(x - cell_x), v = smooth(y - cell_y);
  const float near = glm::mix(lattice(i, j, seed), lattice(i + 1, j, seed), u);
  const float far = glm::mix(lattice(i, j + 1, seed), lattice(i + 1, j + 1, seed), u);
  return glm::mix(near, far, v);
}

float fractal_noise(float x, float y, int octaves, std::uint32_t seed) {
  float sum = 0, height = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += height * value_noise(x, y, seed + static_cast<std::uint32_t>(octave));
    x *= 2, y *= 2, height *= 0.5f;
  }
  return sum;
}

}  // namespace coppice
