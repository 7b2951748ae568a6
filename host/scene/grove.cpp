#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "scene/generators.h"
#include "scene/grove_trees.h"
#include "scene/motion.h"
#include "scene/shapes.h"

// The built-in scene: a coppiced wood. Trees that are cut to the stool every few years and grow again from
// it, each shoot anew: what a builder does to its tree in every frame.

namespace coppice {
namespace {

std::vector<Material> grove_materials() {
  struct Colour {
    const char* name;
    glm::vec3 rgb;
  };
  constexpr std::array colours = std::to_array<Colour>({
      {"moss", {0.27f, 0.34f, 0.11f}},
      {"grass", {0.33f, 0.42f, 0.14f}},
      {"litter", {0.42f, 0.30f, 0.16f}},
      {"earth", {0.30f, 0.21f, 0.13f}},
      {"old bark", {0.26f, 0.20f, 0.15f}},
      {"young bark", {0.45f, 0.38f, 0.27f}},
      {"hazel bark", {0.40f, 0.28f, 0.18f}},
      {"cut wood", {0.86f, 0.68f, 0.42f}},
      {"dark leaf", {0.16f, 0.33f, 0.09f}},
      {"leaf", {0.27f, 0.47f, 0.12f}},
      {"light leaf", {0.44f, 0.62f, 0.17f}},
      {"yellow leaf", {0.72f, 0.62f, 0.16f}},
      {"stone", {0.42f, 0.42f, 0.40f}},
      {"pale stone", {0.55f, 0.53f, 0.48f}},
      {"fern", {0.30f, 0.50f, 0.18f}},
  });
  std::vector<Material> materials;
  for (const Colour& colour : colours) {
    Material& material = materials.emplace_back();
    material.name = colour.name;
    material.diffuse = colour.rgb;
  }
  return materials;
}

constexpr float GROUND_HALF = 26.0f;  // metres
constexpr std::uint32_t GROUND_CELLS = 120;

float ground_height(float x, float z) {
  const float rim = 0.0035f * (x * x + z * z);  // a shallow bowl, so that the wood closes behind the clearing
  return 0.55f * fractal_noise(0.13f * x, 0.13f * z, 4, 11) + rim * 0.6f;
}

glm::vec3 on_ground(float x, float z) { return {x, ground_height(x, z), z}; }

void append_ground(Scene& scene, Random& random) {
  const auto place = [](std::uint32_t i, std::uint32_t j) {
    const float cell = 2 * GROUND_HALF / GROUND_CELLS;
    const float x = static_cast<float>(i) * cell - GROUND_HALF,
                z = static_cast<float>(j) * cell - GROUND_HALF;
    return on_ground(x + 0.3f * cell * value_noise(3.1f * x, 3.1f * z, 5),
                     z + 0.3f * cell * value_noise(3.1f * x, 3.1f * z, 6));
  };
  const auto cover = [&](glm::vec3 p) {
    const float patch = fractal_noise(0.25f * p.x, 0.25f * p.z, 3, 23) + random.uniform(-0.35f, 0.35f);
    return patch < -0.55f ? EARTH : patch < -0.1f ? LITTER : patch < 0.35f ? MOSS : GRASS;
  };
  for (std::uint32_t j = 0; j < GROUND_CELLS; ++j) {
    for (std::uint32_t i = 0; i < GROUND_CELLS; ++i) {
      const glm::vec3 a = place(i, j), b = place(i + 1, j), c = place(i, j + 1), d = place(i + 1, j + 1);
      append_triangle(scene, a, c, b, cover(a));
      append_triangle(scene, b, c, d, cover(d));
    }
  }
}

// A felled stem: bark around, pale wood at both ends.
void append_log(Scene& scene, glm::vec3 from, glm::vec3 to, float radius, GroveMaterial bark,
                Random& random) {
  constexpr std::size_t rings = 7;
  constexpr std::uint32_t sides = 14;
  std::array<glm::vec3, rings> path;
  std::array<float, rings> radii;
  for (std::size_t i = 0; i < rings; ++i) {
    const float t = static_cast<float>(i) / (rings - 1);
    path[i] = glm::mix(from, to, t) + 0.06f * radius * random.in_cube();
    radii[i] = radius * (1.0f - 0.12f * t);
  }
  append_tube(scene, path, radii, sides, 0.04f, random, bark);
  const glm::vec3 axis = glm::normalize(to - from);
  append_disc(scene, path[0] - 0.005f * axis, -axis, radii[0] * 0.97f, sides, CUT_WOOD);
  append_disc(scene, path[rings - 1] + 0.005f * axis, axis, radii[rings - 1] * 0.97f, sides, CUT_WOOD);
}

// Cut stems stacked three, two, one, as they wait at the edge of a clearing.
void append_stack(Scene& scene, glm::vec2 middle, glm::vec2 along, Random& random) {
  const float radius = 0.19f;
  const glm::vec2 across{-along.y, along.x};
  const float base = ground_height(middle.x, middle.y) + radius;
  for (int layer = 0; layer < 4; ++layer) {
    for (int i = 0; i < 4 - layer; ++i) {
      const float side = (static_cast<float>(i) - 0.5f * static_cast<float>(3 - layer)) * 2.0f * radius;
      const float slip = random.uniform(-0.15f, 0.15f);
      const glm::vec2 from = middle + side * across + (slip - 1.3f) * along;
      const glm::vec2 to = middle + side * across + (slip + 1.3f) * along;
      const float y = base + 1.74f * radius * static_cast<float>(layer);
      append_log(scene, {from.x, y, from.y}, {to.x, y, to.y}, radius * random.uniform(0.92f, 1.05f),
                 (i + layer) % 2 == 0 ? HAZEL_BARK : YOUNG_BARK, random);
    }
  }
}

void append_fern(Scene& scene, glm::vec3 foot, Random& random) {
  const std::uint32_t fronds = 6 + random.below(4);
  const float offset = random.uniform();
  for (std::uint32_t i = 0; i < fronds; ++i) {
    const glm::vec2 circle = turn_to_circle(offset + static_cast<float>(i) / static_cast<float>(fronds));
    const glm::vec3 out{circle.x, 0, circle.y}, across{-circle.y, 0, circle.x};
    const float length = random.uniform(0.5f, 0.95f);
    for (int k = 1; k <= 7; ++k) {
      const float t = static_cast<float>(k) / 7.0f;
      const glm::vec3 stem = foot + length * (t * out + glm::vec3{0, 1.25f * t - 0.8f * t * t, 0});
      const float size = 0.34f * length * (1.05f - t);
      for (const float side : {-1.0f, 1.0f}) {
        append_leaf(scene, stem, size * glm::normalize(side * across + 0.45f * out), 0.06f * length * out,
                    FERN);
      }
    }
  }
}

bool is_clear(glm::vec2 place, const std::vector<glm::vec2>& taken, float distance) {
  for (const glm::vec2 other : taken) {
    const glm::vec2 apart = place - other;
    if (apart.x * apart.x + apart.y * apart.y < distance * distance) return false;
  }
  return true;
}

// Random places in the wood, `distance` apart and outside of the clearing in front of the camera.
std::vector<glm::vec2> stool_places(Random& random) {
  std::vector<glm::vec2> places;
  for (int attempt = 0; attempt < 4000 && places.size() < 26; ++attempt) {
    const float x = random.uniform(-20, 20), z = random.uniform(-22, 7);
    const float clearing = (x - 0.5f) * (x - 0.5f) / 30.0f + (z - 4.0f) * (z - 4.0f) / 50.0f;
    if (clearing > 1 && is_clear({x, z}, places, 4.2f)) places.emplace_back(x, z);
  }
  return places;
}

void append_wood(Scene& scene, Random& random) {
  constexpr std::array<std::array<GroveMaterial, 3>, 3> foliage = {{{LEAF_DARK, LEAF_MID, LEAF_MID},
                                                                    {LEAF_MID, LEAF_LIGHT, LEAF_LIGHT},
                                                                    {LEAF_LIGHT, LEAF_YELLOW, LEAF_MID}}};
  constexpr std::array barks = {OLD_BARK, YOUNG_BARK, HAZEL_BARK};
  for (const glm::vec2 place : stool_places(random)) {
    const std::uint32_t kind = random.below(3);
    const float radius = random.uniform(0.38f, 0.62f), height = random.uniform(3.6f, 6.2f);
    const int shoot_count = 4 + static_cast<int>(random.below(4));
    append_stool(scene,
                 {on_ground(place.x, place.y), radius, height, shoot_count, barks[kind], foliage[kind], 11},
                 random);
  }
  // In the clearing: stools freshly cut, and some in their first spring after it.
  constexpr std::array<glm::vec2, 7> cut = {{{-3.4f, 6.2f},
                                             {2.9f, 3.4f},
                                             {-0.9f, 1.2f},
                                             {4.6f, 6.6f},
                                             {-4.1f, 1.6f},
                                             {0.9f, -1.6f},
                                             {-1.4f, 5.0f}}};
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const bool regrown = i % 2 == 0;
    append_stool(scene,
                 {on_ground(cut[i].x, cut[i].y),
                  random.uniform(0.34f, 0.5f),
                  regrown ? 1.35f : 0.0f,
                  regrown ? 9 : 0,
                  HAZEL_BARK,
                  {LEAF_LIGHT, LEAF_LIGHT, LEAF_MID},
                  5},
                 random);
  }
}

void append_floor(Scene& scene, Random& random) {
  append_stack(scene, {3.4f, -0.2f}, glm::normalize(glm::vec2{0.62f, 0.78f}), random);
  append_log(scene, on_ground(-3.0f, 3.4f) + glm::vec3{0, 0.2f, 0},
             on_ground(-0.3f, 4.1f) + glm::vec3{0, 0.16f, 0}, 0.22f, YOUNG_BARK, random);
  append_log(scene, on_ground(-5.6f, 2.2f) + glm::vec3{0, 0.2f, 0},
             on_ground(-6.9f, 5.0f) + glm::vec3{0, 0.2f, 0}, 0.25f, OLD_BARK, random);
  for (int i = 0; i < 26; ++i) {
    const float x = random.uniform(-15, 15), z = random.uniform(-12, 9), size = random.uniform(0.12f, 0.55f);
    const glm::vec3 extent = size * glm::vec3{1.3f, 0.8f, 1.0f} * (glm::vec3{1} + 0.25f * random.in_cube());
    append_rock(scene, on_ground(x, z) + glm::vec3{0, 0.15f * size, 0}, extent, random,
                i % 3 == 0 ? STONE_PALE : STONE);
  }
  for (int i = 0; i < 70; ++i) {
    const float x = random.uniform(-16, 16), z = random.uniform(-14, 9);
    append_fern(scene, on_ground(x, z), random);
  }
}

// All that stands over the ground bends, by the square of its height: trees much, stones and ground next to
// nothing.
std::shared_ptr<const Motion> wind_in(const Scene& scene) {
  const auto motion = std::make_shared<Motion>();
  motion->rest = scene.positions;
  motion->deformations = {
      {.vertices = {.first = 0, .count = static_cast<std::uint32_t>(scene.positions.size())},
       .kind = DeformKind::sway,
       .size = 7,
       .amount = 0.05f,
       .seconds = 4}};
  motion->duration_seconds = 4;
  return motion;
}

}  // namespace

Scene make_grove() {
  Scene scene;
  scene.name = "grove";
  scene.materials = grove_materials();
  // A stream of numbers for each part, so that a change to one leaves the others as they are.
  Random ground(1), wood(9), floor(3);
  append_ground(scene, ground);
  append_wood(scene, wood);
  append_floor(scene, floor);
  scene.camera = Camera{.position = {-1.6f, 3.1f, 14.2f},
                        .target = {0.2f, 1.75f, 0},
                        .up = {0, 1, 0},
                        .vertical_fov_degrees = 42};
  scene.light.direction = glm::normalize(glm::vec3{0.62f, 0.66f, 0.42f});
  scene.light.radiance = {1.25f, 1.15f, 0.95f};
  scene.ambient_light = {0.30f, 0.34f, 0.40f};
  scene.motion = wind_in(scene);
  return scene;
}

}  // namespace coppice
