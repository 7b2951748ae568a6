#pragma once

#include <array>
#include <cstdint>

#include "scene/shapes.h"

namespace coppice {

// Indices into the materials of the grove.
enum GroveMaterial : std::uint32_t {
  MOSS,
  GRASS,
  LITTER,
  EARTH,
  OLD_BARK,
  YOUNG_BARK,
  HAZEL_BARK,
  CUT_WOOD,
  LEAF_DARK,
  LEAF_MID,
  LEAF_LIGHT,
  LEAF_YELLOW,
  STONE,
  STONE_PALE,
  FERN,
};

// What sets one stool apart from another.
struct Stool {
  glm::vec3 foot;
  float radius;  // of the stump
  float height;  // of its tallest shoots; 0: freshly cut
  int shoot_count;
  GroveMaterial bark;
  std::array<GroveMaterial, 3> leaves;
  int leaves_per_twig;
};

// Appends the stump and its shoots, with twigs and leaves.
void append_stool(Scene& scene, const Stool& stool, Random& random);

}  // namespace coppice
