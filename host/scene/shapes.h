#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scene/random.h"
#include "scene/scene.h"

namespace coppice {

// A material that is nothing but a colour.
Material coloured(std::string name, glm::vec3 colour);

// Appends one triangle with vertices of its own.
void append_triangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c, std::uint32_t material);

// Appends a ring-by-ring tube around a path of at least two points, `sides` corners a ring, 2 * sides
// triangles a segment. Ring i has radius[i]; each corner is moved in or out by up to `roughness` of it. No
// caps.
void append_tube(Scene& scene, std::span<const glm::vec3> path, std::span<const float> radius,
                 std::uint32_t sides, float roughness, Random& random, std::uint32_t material);

// Appends a disc as a fan of `sides` triangles, facing along `normal`.
void append_disc(Scene& scene, glm::vec3 centre, glm::vec3 normal, float radius, std::uint32_t sides,
                 std::uint32_t material);

// Appends an irregular stone: an octahedron subdivided three times (512 triangles), its radius roughened by
// smooth noise.
void append_rock(Scene& scene, glm::vec3 centre, glm::vec3 half_extent, Random& random,
                 std::uint32_t material);

// Appends a leaf of two triangles, folded along its midrib, from `stem` along `forward` (its length).
void append_leaf(Scene& scene, glm::vec3 stem, glm::vec3 forward, glm::vec3 sideways, std::uint32_t material);

// Smooth noise in [-1, 1] over the plane, with one bump per unit.
float value_noise(float x, float y, std::uint32_t seed);

// `octaves` octaves of value_noise, each of half the size and half the height of the one before; in (-2, 2).
float fractal_noise(float x, float y, int octaves, std::uint32_t seed);

}  // namespace coppice
