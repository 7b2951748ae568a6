#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "interface/types.h"
#include "scene/random.h"

namespace coppice {

// Draws small scenes that are hard on builders: mixtures of shapes, few distinct coordinates (so that
// distances and codes tie), copies, outliers, the ends of the range of float, non-finite corners.
class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : random_(seed * 0x9e3779b97f4a7c15u) {}

  Random& random() { return random_; }

  // As scene_arrays hands them over: without denormals and -0. One time in eight all in one plane, one time
  // in six times a power of two that may take coordinates out of the range of float.
  std::vector<Triangle> triangles(std::uint32_t count) {
    cells_ = 1 + random_.below(chance(3) ? 3 : 16);
    const std::array kinds = {random_.below(KINDS), random_.below(KINDS), random_.below(KINDS)};
    std::vector<Triangle> triangles;
    while (triangles.size() < count) triangles.push_back(next(kinds[random_.below(3)], triangles));
    if (chance(4)) triangles[random_.below(count)] = outlier();
    if (chance(8)) flatten(triangles);
    if (chance(4)) spoil(triangles);
    const int exponent = !chance(3) ? 0 : static_cast<int>(random_.below(281)) - 140;
    for (Triangle& triangle : triangles) {
      for (vec3* const corner : {&triangle.a, &triangle.b, &triangle.c}) scale_and_flush(*corner, exponent);
    }
    return triangles;
  }

 private:
  static constexpr std::uint32_t KINDS = 11;

  bool chance(std::uint32_t one_in) { return random_.below(one_in) == 0; }

  float grid_coordinate() { return static_cast<float>(random_.below(cells_ + 1)); }
  vec3 grid_point() {
    const float x = grid_coordinate(), y = grid_coordinate(), z = grid_coordinate();
    return {x, y, z};
  }
  Triangle around(vec3 centre, float size) {
    const vec3 a = centre + size * random_.in_cube(), b = centre + size * random_.in_cube();
    return {a, b, centre + size * random_.in_cube()};
  }

  Triangle next(std::uint32_t kind, const std::vector<Triangle>& before) {
    const auto i = static_cast<float>(before.size());
    const vec3 point = random_.in_cube();
    switch (kind) {
      case 0:  // soup
        return around(8.0f * point, 0.5f);
      case 1:  // corners on a coarse grid
      {
        const vec3 a = grid_point(), b = grid_point();
        return {a, b, grid_point()};
      }
      case 2:  // cells of a regular mesh in the plane y = 0, in order
      {
        const vec3 corner(std::fmod(i, 8.0f), 0, std::floor(i / 8.0f));
        return {corner, corner + vec3(1, 0, 0), corner + vec3(0, 0, 1)};
      }
      case 3:  // a copy
        return before.empty() ? around(point, 1) : before[random_.below(static_cast<std::uint32_t>(i))];
      case 4:  // a point or a segment
        return {grid_point(), grid_point(), vec3(0)};
      case 5:  // a point
        return {point, point, point};
      case 6:  // a needle
        return {point, point + 20.0f * random_.direction(), point + vec3(1e-6f)};
      case 7:  // boxes around one centre
        return {vec3(-i), vec3(i), vec3(i, -i, i)};
      case 8:  // a row in which the next one is the nearest
        return {vec3(3 * i, 0, 0), vec3(3 * i + 1, 0, 0), vec3(3 * i, 1 - i * 0x1p-20f, 0)};
      case 9:  // a speck, below the floor of normalised coordinates if the scene is large
        return around(vec3(0), std::ldexp(1.0f, -40 - static_cast<int>(random_.below(80))));
      default:  // a crowd
        return around(vec3(1) + 1e-5f * point, 1e-6f);
    }
  }

  Triangle outlier() {
    const float distance = std::ldexp(1.0f, static_cast<int>(random_.below(40)));
    return around(distance * random_.direction(), 1);
  }

  void flatten(std::vector<Triangle>& triangles) {
    const int axis = static_cast<int>(random_.below(3));
    for (Triangle& triangle : triangles) triangle.a[axis] = triangle.b[axis] = triangle.c[axis] = 1;
  }

  void spoil(std::vector<Triangle>& triangles) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr std::array values = {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity};
    const std::uint32_t one_in = 1 + random_.below(8);
    for (Triangle& triangle : triangles) {
      if (!chance(one_in)) continue;
      vec3* const corners[] = {&triangle.a, &triangle.b, &triangle.c};
      const std::uint32_t corner = random_.below(3), axis = random_.below(3);
      (*corners[corner])[static_cast<int>(axis)] = values[random_.below(3)];
    }
  }

  static void scale_and_flush(vec3& corner, int exponent) {
    for (int axis = 0; axis < 3; ++axis) {
      corner[axis] = std::ldexp(corner[axis], exponent);
      if (corner[axis] == 0 || std::fpclassify(corner[axis]) == FP_SUBNORMAL) corner[axis] = 0;
    }
  }

  Random random_;
  std::uint32_t cells_ = 1;
};

inline std::uint64_t number_from_environment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text && *text ? std::strtoull(text, nullptr, 10) : otherwise;
}

// Calls check(scene) for COPPICE_PROPERTY_SCENES scenes, of the seeds from COPPICE_PROPERTY_SEED on, and
// stops at the first that fails. Its own seed is printed, so that it can be run alone.
template <class Check>
void for_random_scenes(std::uint64_t count_by_default, Check check) {
  const std::uint64_t first = number_from_environment("COPPICE_PROPERTY_SEED", 1);
  const std::uint64_t count = number_from_environment("COPPICE_PROPERTY_SCENES", count_by_default);
  for (std::uint64_t seed = first; seed < first + count && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("alone: COPPICE_PROPERTY_SCENES=1 COPPICE_PROPERTY_SEED=" + std::to_string(seed));
    RandomScene scene(seed);
    check(scene);
  }
}

}  // namespace coppice
