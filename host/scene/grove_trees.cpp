#include "scene/grove_trees.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace coppice {
namespace {

void append_leaves(Scene& scene, const Stool& stool, glm::vec3 from, glm::vec3 to, Random& random) {
  for (int i = 0; i < stool.leaves_per_twig; ++i) {
    const glm::vec3 stem = glm::mix(from, to, 0.25f + 0.75f * random.uniform());
    glm::vec3 forward = random.direction();
    forward.y = 0.45f * forward.y - 0.12f;  // leaves lie flat, and hang a little
    forward = glm::normalize(forward) * random.uniform(0.14f, 0.25f);
    const glm::vec3 sideways =
        glm::cross(forward, glm::normalize(glm::vec3{0, 1, 0} + 0.5f * random.in_cube()));
    const auto leaf = stool.leaves[random.below(3)];
    append_leaf(scene, stem + 0.1f * random.in_cube(), forward, 0.38f * sideways, leaf);
  }
}

void append_twig(Scene& scene, const Stool& stool, glm::vec3 from, glm::vec3 outward, float length,
                 float radius, Random& random) {
  std::array<glm::vec3, 4> path;
  std::array<float, 4> radii;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const float t = static_cast<float>(i) / 3.0f;
    const glm::vec3 rise{0, length * (0.25f * t + 0.35f * t * t), 0};
    path[i] = from + length * t * outward + rise + 0.05f * length * t * random.in_cube();
    radii[i] = radius * (1.0f - 0.85f * t);
  }
  append_tube(scene, path, radii, 4, 0.0f, random, stool.bark);
  append_leaves(scene, stool, path[1], path[3], random);
}

// A shoot leaves the stump's rim outward, bends up towards the light and thins out; twigs stand on its upper
// half.
void append_shoot(Scene& scene, const Stool& stool, glm::vec2 outward, Random& random) {
  constexpr std::size_t rings = 10;
  const float height = stool.height * random.uniform(0.65f, 1.0f);
  const float reach = height * random.uniform(0.16f, 0.42f);
  const float thickness = stool.radius * random.uniform(0.13f, 0.24f);
  const glm::vec3 out{outward.x, 0, outward.y};
  const glm::vec3 start = stool.foot + 0.75f * stool.radius * out + glm::vec3{0, 0.55f * stool.radius, 0};
  const glm::vec3 sway = 0.05f * height * random.in_cube();

  std::array<glm::vec3, rings> path;
  std::array<float, rings> radii;
  for (std::size_t i = 0; i < rings; ++i) {
    const float t = static_cast<float>(i) / (rings - 1);
    const float bend = t * (1.7f - 0.7f * t);  // outward at first, then upright
    path[i] = start + reach * bend * out + glm::vec3{0, height * t * (0.75f + 0.25f * t), 0} +
              sway * t * (1 - t) * 4.0f;
    path[i] += 0.012f * height * random.in_cube() * t;
    radii[i] = thickness * (1.0f - 0.88f * t) * (i == 0 ? 1.35f : 1.0f);
  }
  append_tube(scene, path, radii, 7, 0.06f, random, stool.bark);

  for (std::size_t ring = 3; ring < rings; ++ring) {
    const float t = static_cast<float>(ring) / (rings - 1);
    const std::uint32_t twig_count = ring < 6 ? 1 + random.below(2) : 2 + random.below(2);
    for (std::uint32_t k = 0; k < twig_count; ++k) {
      glm::vec3 side = random.direction() + 0.35f * out;
      side.y = 0.25f * side.y;
      const float length = height * random.uniform(0.09f, 0.20f) * (1.25f - 0.6f * t);
      append_twig(scene, stool, path[ring], glm::normalize(side), length, radii[ring] * 0.45f + 0.004f,
                  random);
    }
  }
}

// A stump: a flaring, knobbly tube with a pale cut on top.
void append_stump(Scene& scene, const Stool& stool, Random& random) {
  const float r = stool.radius;
  const std::array path = {stool.foot - glm::vec3{0, 0.5f * r, 0}, stool.foot + glm::vec3{0, 0.1f * r, 0},
                           stool.foot + glm::vec3{0, 0.45f * r, 0}, stool.foot + glm::vec3{0, 0.85f * r, 0}};
  const std::array radii = {1.45f * r, 1.2f * r, 1.0f * r, 0.92f * r};
  append_tube(scene, path, radii, 18, 0.10f, random, OLD_BARK);
  append_disc(scene, path[3] - glm::vec3{0, 0.02f * r, 0}, {0, 1, 0}, 0.93f * r, 18,
              stool.height == 0 ? CUT_WOOD : LITTER);
}

}  // namespace

void append_stool(Scene& scene, const Stool& stool, Random& random) {
  append_stump(scene, stool, random);
  const float offset = random.uniform();
  for (int i = 0; i < stool.shoot_count; ++i) {
    const float turns = offset + (static_cast<float>(i) + random.uniform(-0.3f, 0.3f)) /
                                     static_cast<float>(stool.shoot_count);
    append_shoot(scene, stool, turn_to_circle(turns), random);
  }
}

}  // namespace coppice
