#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/common.hpp>
#include <numeric>
#include <span>
#include <vector>

#include "builders/morton_leaves.h"
#include "builders/threads.h"
#include "interface/types.h"
#include "scene/random.h"

// Scenes, what is done to them, and how the trees before and after compare.
namespace coppice {

using Triangles = std::vector<Triangle>;

// Small triangles far apart in [0, 1)^3. No two centres agree on an axis, and boxes do not contain each
// other.
inline Triangles sparse_soup(std::uint32_t count, std::uint64_t seed) {
  Random random(seed);
  Triangles triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const vec3 centre = 0.5f + 0.49f * random.in_cube();
    const vec3 a = centre + 0.002f * random.in_cube(), b = centre + 0.002f * random.in_cube();
    triangles.push_back({a, b, centre + 0.002f * random.in_cube()});
  }
  return triangles;
}

// The same with corners at whole numbers from 0 to 2047: all sums and areas are exact.
inline Triangles whole_number_soup(std::uint32_t count, std::uint64_t seed) {
  Random random(seed);
  const auto point = [&](std::uint32_t cells) {
    const std::uint32_t x = random.below(cells), y = random.below(cells), z = random.below(cells);
    return vec3(x, y, z);
  };
  Triangles triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const vec3 corner = point(2041);
    const vec3 a = corner + point(8), b = corner + point(8);
    triangles.push_back({a, b, corner + point(8)});
  }
  return triangles;
}

template <class Map>
Triangles mapped(const Triangles& triangles, Map map) {
  Triangles result;
  for (const Triangle& t : triangles) result.push_back({map(t.a), map(t.b), map(t.c)});
  return result;
}

// The boxes of `nodes` mapped, by a map that may turn corners around; child and height as they are.
template <class Map>
std::vector<Node> mapped_boxes(std::span<const Node> nodes, Map map) {
  std::vector<Node> result(nodes.begin(), nodes.end());
  for (Node& node : result) {
    const vec3 a = map(node.box_min), b = map(node.box_max);
    node.box_min = glm::min(a, b);
    node.box_max = glm::max(a, b);
  }
  return result;
}

struct Shuffled {
  Triangles triangles;
  std::vector<std::uint32_t> from;  // triangles[i] was from[i]
};

inline Shuffled shuffled(const Triangles& triangles, std::uint64_t seed) {
  Random random(seed);
  Shuffled result{{}, std::vector<std::uint32_t>(triangles.size())};
  std::iota(result.from.begin(), result.from.end(), 0u);
  for (std::size_t i = triangles.size(); i > 1; --i) {
    std::swap(result.from[i - 1], result.from[random.below(static_cast<std::uint32_t>(i))]);
  }
  for (const std::uint32_t index : result.from) result.triangles.push_back(triangles[index]);
  return result;
}

// A tree over shuffled triangles with the leaves named as before.
inline std::vector<Node> with_old_names(std::span<const Node> nodes, const Shuffled& shuffled) {
  std::vector<Node> result(nodes.begin(), nodes.end());
  for (Node& node : result) {
    if (node.height == 0) node.child = shuffled.from[node.child];
  }
  return result;
}

// Each triangle twice in a row.
inline Triangles doubled(const Triangles& triangles) {
  Triangles result;
  for (const Triangle& triangle : triangles) result.insert(result.end(), {triangle, triangle});
  return result;
}

inline bool same_bits(std::span<const Node> a, std::span<const Node> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

// The boxes of the internal nodes and, where asked for, of the leaves, sorted: a tree without its numbering
// and without the order of its children.
using Boxes = std::vector<std::array<float, 6>>;
inline Boxes sorted_boxes(std::span<const Node> nodes, bool with_leaves = false) {
  Boxes boxes;
  for (const Node& node : nodes) {
    if (node.height == 0 && !with_leaves) continue;
    boxes.push_back(
        {node.box_min.x, node.box_min.y, node.box_min.z, node.box_max.x, node.box_max.y, node.box_max.z});
  }
  std::sort(boxes.begin(), boxes.end());
  return boxes;
}

inline bool has_equal_codes(const Triangles& triangles, std::uint32_t morton_bits) {
  MortonLeaves leaves = make_morton_leaves(triangles, morton_bits, Threads(1));
  std::sort(leaves.codes.begin(), leaves.codes.end());
  return std::adjacent_find(leaves.codes.begin(), leaves.codes.end()) != leaves.codes.end();
}

}  // namespace coppice
