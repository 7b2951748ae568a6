#include "scene/hard_cases.h"

#include <array>
#include <cmath>
#include <limits>

#include "scene/generators.h"
#include "scene/random.h"
#include "scene/shapes.h"

namespace coppice {
namespace {

constexpr float INF = std::numeric_limits<float>::infinity();
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

Scene reserved(std::uint32_t triangle_count) {
  Scene scene;
  scene.positions.reserve(std::size_t{triangle_count} * 3);
  scene.indices.reserve(triangle_count);
  scene.material_index.reserve(triangle_count);
  return scene;
}

// Appends a triangle with its corners in a cube of half side `size` around `centre`.
void append_random(Scene& scene, glm::vec3 centre, float size, Random& random) {
  const glm::vec3 a = centre + size * random.in_cube();
  const glm::vec3 b = centre + size * random.in_cube();
  append_triangle(scene, a, b, centre + size * random.in_cube(), 0);
}

// Every distance and every Morton code ties.
Scene coincident(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    append_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  return scene;
}

// A row along x in which the nearest neighbour of each triangle, by surface area of the union box, is the
// next one, so that a clustering by mutual nearest neighbours merges one pair a round. The obvious row, with
// gaps that shrink, runs out of float: in each binade of the position a gap can shrink by an ulp some 2,400
// times only. So the places stay put and the heights shrink: box i is [3i, 3i + 1] x [0, 1 - (i + 1) 2^-24] x
// {0}; the union of i and i + 1 is 4 by the height of i, whose area falls from each i to the next. All of
// this is exact in float up to i = (2^24 - 1) / 3, which is 5,592,405; beyond that the coordinates round and
// boxes begin to coincide. The order along the row is also the order of the Morton codes (with ties in index
// order) on a grid of cubic cells, 2^10 or 2^20 a side, a power of two wide, that starts at the scene's
// corner: all centres fall into one row of its cells.
Scene shrinking_gaps(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float x = 3.0f * static_cast<float>(i);
    const float height = 1.0f - static_cast<float>(i + 1) * 0x1p-24f;
    append_triangle(scene, {x, 0, 0}, {x + 1, 0, 0}, {x, height, 0}, 0);
  }
  return scene;
}

// Boxes around one centre: all Morton codes tie, no distance does.
Scene nested(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float s = static_cast<float>(i + 1) * 0x1p-10f;
    append_triangle(scene, {-s, -s, -s}, {s, -s, s}, {0, s, 0}, 0);
  }
  return scene;
}

// One outlier stretches the grid until all the others fall into one cell of it.
Scene one_cell(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i + 1 < triangle_count; ++i) {
    append_random(scene, glm::vec3{1e-4f} + 5e-5f * random.in_cube(), 1e-6f, random);
  }
  if (triangle_count > 0) append_random(scene, glm::vec3{1e4f}, 1, random);
  return scene;
}

Scene planar_grid(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = make_terrain(triangle_count);
  for (glm::vec3& position : scene.positions) position.y = 0;
  scene.materials = {Material{}};
  scene.material_index.assign(triangle_count, 0);
  return scene;
}

// Spoils one coordinate of the triangle in turn: each corner, each axis, NaN and both infinities.
void spoil(Scene& scene, std::uint32_t triangle, std::uint32_t turn) {
  constexpr std::array values = {NOT_A_NUMBER, INF, -INF};
  scene.positions[triangle * 3 + turn % 3][static_cast<int>(turn / 3 % 3)] = values[turn / 9 % 3];
}

Scene spoilt(std::uint32_t triangle_count, std::uint64_t seed, std::uint32_t every) {
  Scene scene = reserved(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    append_random(scene, 10.0f * random.in_cube(), 1, random);
  for (std::uint32_t i = 0; i < triangle_count; i += every) spoil(scene, i, i / every);
  return scene;
}

Scene non_finite(std::uint32_t triangle_count, std::uint64_t seed) { return spoilt(triangle_count, seed, 3); }
Scene all_non_finite(std::uint32_t triangle_count, std::uint64_t seed) {
  return spoilt(triangle_count, seed, 1);
}

// Extents, areas and sums of coordinates overflow.
Scene huge(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    append_random(scene, 1.5e38f * random.in_cube(), i % 2 == 0 ? 1.5e38f : 1e36f, random);
  }
  return scene;
}

// Around the least normal float, 1.2e-38: areas underflow, and a device may flush some of the coordinates to
// zero.
Scene tiny(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    append_random(scene, 3e-38f * random.in_cube(), 1e-38f, random);
  return scene;
}

Scene mixed_scales(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float scale = i % 2 == 0 ? 1e-20f : 1e20f;
    append_random(scene, scale * random.in_cube(), 0.1f * scale, random);
  }
  return scene;
}

// Far from the origin, where an ulp is 2^-6 and neighbouring vertices of the mesh begin to coincide.
Scene far(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = make_terrain(triangle_count);
  for (glm::vec3& position : scene.positions) position += glm::vec3{148376, 1234, -223423};
  return scene;
}

// Degenerate triangles, by turns a point and a segment: legal, in the tree, never hit.
Scene points(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved(triangle_count);
  Random random(seed);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const glm::vec3 a = 10.0f * random.in_cube();
    const glm::vec3 b = i % 2 == 0 ? a : a + random.in_cube();
    append_triangle(scene, a, b, a, 0);
  }
  return scene;
}

// Coordinates -1, -0, 0 and 1: equal boxes whose bits differ, coplanar with the axes' planes.
Scene negative_zero(std::uint32_t triangle_count, std::uint64_t seed) {
  Scene scene = reserved(triangle_count);
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

constexpr std::array HARD_CASES = std::to_array<HardCase>({
    {"coincident", "copies of one triangle", 100'000, coincident},
    {"shrinking-gaps", "a row in which each one's nearest neighbour is the next one", 1'000'000,
     shrinking_gaps},
    {"nested", "growing boxes around one centre", 10'000, nested},
    {"one-cell", "a tiny cluster and one far outlier", 10'000, one_cell},
    {"planar-grid", "a grid in an axis-aligned plane, of no extent across it", 10'000, planar_grid},
    {"non-finite", "every third triangle has a NaN or an infinite vertex", 1'000, non_finite},
    {"all-non-finite", "every triangle has a NaN or an infinite vertex", 100, all_non_finite},
    {"huge", "coordinates up to 3e38", 1'000, huge},
    {"tiny", "coordinates near 1e-38, denormals among them", 1'000, tiny},
    {"mixed-scales", "triangles of size 1e-20 and 1e20 around one centre", 1'000, mixed_scales},
    {"far", "a terrain moved to (148376, 1234, -223423)", 10'000, far},
    {"points", "triangles that are points and segments", 1'000, points},
    {"negative-zero", "coordinates -1, -0, 0 and 1", 1'000, negative_zero},
});

}  // namespace

std::span<const HardCase> hard_cases() { return HARD_CASES; }

const HardCase* find_hard_case(std::string_view name) {
  for (const HardCase& hard_case : HARD_CASES) {
    if (hard_case.name == name) return &hard_case;
  }
  return nullptr;
}

}  // namespace coppice
