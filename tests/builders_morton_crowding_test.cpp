// Ordinary scenes keep Morton codes of 30 bits; a teapot in a stadium gets 60, and a better tree by them.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "builders/lbvh.h"
#include "builders/leaves.h"
#include "builders/morton_crowding.h"
#include "builders/morton_order.h"
#include "builders/normalised_space.h"
#include "builders/ploc.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "scene/scene_source.h"
#include "support/triangles.h"

namespace coppice {
namespace {

// By definition: every pair of active triangles, with the codes of the builders.
double crowding_of_all(const std::vector<Triangle>& triangles, int bits_per_axis) {
  const std::vector<Node> leaves = make_leaves(triangles);
  const NormalisedSpace to_normalised(bounds_of(leaves));
  std::vector<Aabb> boxes;
  for (const Node& leaf : leaves) boxes.push_back(to_normalised(Aabb{leaf.box_min, leaf.box_max}));
  std::vector<std::uint64_t> codes = morton_codes(boxes, bits_per_axis);
  std::sort(codes.begin(), codes.end());
  double others = 0;
  for (const std::uint64_t code : codes) {
    const auto [first, last] = std::equal_range(codes.begin(), codes.end(), code);
    others += static_cast<double>(last - first - 1);
  }
  return others / static_cast<double>(codes.size());
}

// A soup of `count` small triangles in random order in one cell of 30 bits, which is 4 wide, and one triangle
// far away.
std::vector<Triangle> teapot_in_a_stadium(std::uint32_t count) {
  Random random(count);
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const vec3 centre = vec3(1.5f) + 0.5f * random.direction();
    const vec3 a = centre + 0.01f * random.in_cube(), b = centre + 0.01f * random.in_cube();
    triangles.push_back({a, b, centre});
  }
  triangles.push_back({vec3(0), vec3(0), vec3(0)});
  triangles.push_back({vec3(4000), vec3(4001, 4000, 4000), vec3(4000, 4001, 4000)});
  return triangles;
}

// The SAH cost of the teapot's part of the tree: what a ray pays that meets the teapot. Of the whole tree's
// cost it is a millionth, as the teapot is of the stadium's area.
double teapot_cost(std::span<const Node> nodes) {
  double sum = 0, largest = 0;
  for (const Node& node : nodes) {
    const glm::dvec3 extent = glm::dvec3(node.box_max) - glm::dvec3(node.box_min);
    if (std::max({extent.x, extent.y, extent.z}) > 4) continue;
    const double area = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
    sum += area;
    largest = std::max(largest, area);
  }
  return sum / largest;
}

TEST(MortonCrowding, CountsThePairsOfSmallScenesExactly) {
  for (const std::uint32_t count : {2u, 3u, 100u, 3000u}) {
    std::vector<Triangle> triangles = random_soup(count, count);
    for (std::uint32_t i = 0; i < count / 3; ++i) triangles.push_back(triangles[i]);
    triangles.push_back({vec3(300), vec3(300), vec3(300)});
    triangles.front().b.y = std::numeric_limits<float>::quiet_NaN();
    triangles.back().b.y = -std::numeric_limits<float>::infinity();
    for (int turn = 0; turn < 2; ++turn) {
      const MortonCrowding crowding = morton_crowding(triangles);
      EXPECT_NEAR(crowding.with_30_bits, crowding_of_all(triangles, 10), 1e-9) << count << ", " << turn;
      EXPECT_NEAR(crowding.with_60_bits, crowding_of_all(triangles, 20), 1e-9) << count << ", " << turn;
      triangles.back().b.y = 300;  // active now: the grid grows, cells fill
    }
    EXPECT_EQ(morton_crowding(triangles).with_30_bits > 0, count >= 100) << count;
  }
}

TEST(MortonCrowding, IsZeroWithoutPairs) {
  const vec3 nowhere(std::numeric_limits<float>::quiet_NaN());
  for (const std::uint32_t count : {0u, 1u, 4u, 30000u}) {
    const std::vector<Triangle> triangles(count, Triangle{nowhere, nowhere, nowhere});
    EXPECT_EQ(morton_crowding(triangles).with_30_bits, 0) << count;
    EXPECT_EQ(choose_morton_bits(triangles), 30u) << count;
  }
  EXPECT_EQ(morton_crowding(random_soup(1, 1)).with_60_bits, 0);
}

TEST(MortonCrowding, OfASampleIsThatOfAllNearly) {
  for (const char* const scene : {"grove", "scatter:300000", "hard:shrinking-gaps:300000"}) {
    std::vector<Triangle> triangles = scene_arrays(open_scene(scene)).triangles;
    ASSERT_GT(triangles.size(), CROWDING_SAMPLES);
    triangles[5].a.x = std::numeric_limits<float>::infinity();
    const double all = crowding_of_all(triangles, 10);
    const MortonCrowding crowding = morton_crowding(triangles);
    EXPECT_NEAR(crowding.with_30_bits, all, 0.5 + 0.1 * all) << scene;
    EXPECT_NEAR(crowding.with_60_bits, crowding_of_all(triangles, 20), 1) << scene;
    EXPECT_EQ(morton_crowding(triangles).with_30_bits, crowding.with_30_bits) << scene;
  }
}

TEST(ChooseMortonBits, KeepsOrdinaryScenesAt30) {
  for (const char* const scene : {"grove", "terrain:500000", "scatter:100000", "scatter:1000000"}) {
    EXPECT_EQ(choose_morton_bits(scene_arrays(open_scene(scene)).triangles), 30u) << scene;
  }
}

TEST(ChooseMortonBits, KeepsCellsAt30ThatStayCrowded) {
  for (const char* const name : {"coincident", "nested", "one-cell"}) {
    const auto triangles = scene_arrays(find_hard_case(name)->make(10000, 1)).triangles;
    EXPECT_GT(morton_crowding(triangles).with_30_bits, CROWDING_LIMIT) << name;
    EXPECT_EQ(choose_morton_bits(triangles), 30u) << name;
  }
}

TEST(ChooseMortonBits, GivesATeapotInAStadiumABetterTree) {
  const std::vector<Triangle> triangles = teapot_in_a_stadium(10000);
  EXPECT_EQ(choose_morton_bits(triangles), 60u);
  const auto with_ploc = [&](std::uint32_t bits) {
    return teapot_cost(build_ploc(triangles, {16, bits}).nodes);
  };
  EXPECT_GT(with_ploc(30), 8 * with_ploc(60));
  const auto with_lbvh = [&](std::uint32_t bits) {
    return teapot_cost(build_lbvh(triangles, {bits, 2}).nodes);
  };
  EXPECT_GT(with_lbvh(30), 30 * with_lbvh(60));
}

// Where the choice turns, 60 bits are worth it.
TEST(ChooseMortonBits, TurnsWhereRandomOrderCostsAFewTimesAsMuch) {
  const auto limit = static_cast<std::uint32_t>(CROWDING_LIMIT);
  EXPECT_EQ(choose_morton_bits(teapot_in_a_stadium(limit - 10)), 30u);
  const std::vector<Triangle> triangles = teapot_in_a_stadium(limit + 10);
  EXPECT_EQ(choose_morton_bits(triangles), 60u);
  const double cost = teapot_cost(build_ploc(triangles, {16, 60}).nodes);
  EXPECT_GT(teapot_cost(build_ploc(triangles, {16, 30}).nodes), 2.5 * cost);
}

}  // namespace
}  // namespace coppice
