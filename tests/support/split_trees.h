#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/validate.h"
#include "builders/bvh.h"
#include "scene/hard_cases.h"
#include "scene/random.h"

namespace coppice {

// Triangles with edges of about `size` and corners in the cube of half side 1 + size.
inline std::vector<Triangle> split_test_soup(std::uint32_t count, float size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Triangle> soup;
  for (std::uint32_t i = 0; i < count; ++i) {
    const vec3 a = random.in_cube();
    const vec3 to_b = random.in_cube() * size;
    const vec3 to_c = random.in_cube() * size;
    soup.push_back({a, a + to_b, a + to_c});
  }
  return soup;
}

// Needles askew to all axes and almost parallel: their boxes are large, almost empty and overlap.
inline std::vector<Triangle> needles(std::uint32_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const vec3 a = random.in_cube();
    const vec3 b = a + vec3(1, 1, 1) + random.in_cube() * 0.1f;
    triangles.push_back({a, b, a + random.in_cube() * 0.01f});
  }
  return triangles;
}

// A hard case with at most 2000 triangles.
inline std::vector<Triangle> hard_triangles(const HardCase& hard_case) {
  const Scene scene = hard_case.make(std::min(hard_case.default_triangle_count, 2000u), 1);
  std::vector<Triangle> triangles;
  for (const uvec3& corners : scene.indices) {
    triangles.push_back({scene.positions[corners.x], scene.positions[corners.y], scene.positions[corners.z]});
  }
  return triangles;
}

inline void expect_valid_split_tree(const Bvh& bvh, const std::vector<Triangle>& triangles) {
  EXPECT_EQ(find_fault(bvh.nodes, triangles, {.splits_triangles = true}).value_or("no fault"), "no fault");
  EXPECT_EQ(bvh.references, (bvh.nodes.size() + 1) / 2);
}

// Random points of every triangle, corners and edges among them, each lie in the box of one of its leaves. A
// point is computed in double, and may be that far off the triangle.
inline void expect_no_point_lost(const Bvh& bvh, const std::vector<Triangle>& triangles) {
  std::vector<std::vector<Node>> leaves(triangles.size());
  for (const Node& node : bvh.nodes) {
    if (node.height == 0) leaves[node.child].push_back(node);
  }
  Random random(99);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 50; ++k) {
      double u = random.uniform(), v = k % 5 == 0 ? 0.0 : random.uniform();
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      if (k % 5 == 1) v = 1.0 - u;
      const auto is_in = [&](const Node& leaf) {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
          const double a = triangles[i].a[axis], b = triangles[i].b[axis], c = triangles[i].c[axis];
          const double point = a + u * (b - a) + v * (c - a);
          const double tolerance = 1e-15 * (std::abs(a) + std::abs(b) + std::abs(c));
          inside &= point >= leaf.box_min[axis] - tolerance && point <= leaf.box_max[axis] + tolerance;
        }
        return inside;
      };
      ASSERT_TRUE(std::ranges::any_of(leaves[i], is_in)) << "triangle " << i << " at " << u << ", " << v;
    }
  }
}

inline void expect_same_nodes(const Bvh& a, const Bvh& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    ASSERT_TRUE(a.nodes[i].box_min == b.nodes[i].box_min && a.nodes[i].box_max == b.nodes[i].box_max &&
                a.nodes[i].child == b.nodes[i].child && a.nodes[i].height == b.nodes[i].height)
        << "node " << i;
  }
}

inline std::string name_of(const HardCase& hard_case) {
  std::string name(hard_case.name);
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace coppice
