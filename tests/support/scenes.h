#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "scene/hard_cases.h"
#include "scene/scene.h"

namespace coppice {

// The same mesh, signs of zero and NaN included.
inline bool same_bits(const Scene& a, const Scene& b) {
  return a.positions.size() == b.positions.size() && a.indices == b.indices &&
         a.material_index == b.material_index &&
         std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(glm::vec3)) == 0;
}

inline Scene make_hard_case(std::string_view name, std::uint32_t count, std::uint64_t seed = 1) {
  return find_hard_case(name)->make(count, seed);
}

inline void expect_consistent(const Scene& scene) {
  ASSERT_FALSE(scene.materials.empty());
  ASSERT_EQ(scene.material_index.size(), scene.indices.size());
  for (const glm::uvec3 t : scene.indices) ASSERT_LT(std::max({t.x, t.y, t.z}), scene.positions.size());
  for (const std::uint32_t index : scene.material_index) ASSERT_LT(index, scene.materials.size());
}

inline void expect_usable_camera(const Scene& scene) {
  for (const float aspect : {0.1f, 1.0f, 1.7f, 10.0f}) {
    const Camera camera = frame_scene(scene, aspect);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(std::isfinite(camera.position[axis]));
      EXPECT_TRUE(std::isfinite(camera.target[axis]));
    }
    EXPECT_NE(camera.position, camera.target);
  }
}

// The name of a case, as a test may have it.
inline std::string test_name(const HardCase& hard_case) {
  std::string name(hard_case.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace coppice
