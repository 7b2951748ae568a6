// The builders that go by Morton codes, on several threads.
#include "support/builders.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <stdexcept>
#include <vector>

#include "builders/lbvh.h"
#include "builders/morton_leaves.h"
#include "builders/morton_order.h"
#include "builders/ploc.h"
#include "builders/ploc_parallel.h"
#include "builders/threads.h"
#include "scene/random.h"
#include "support/triangles.h"

namespace coppice {
namespace {

// More than one chunk of every kind there is.
constexpr std::uint32_t MANY = 150000;

class OnThreads : public testing::TestWithParam<std::uint32_t> {};

TEST_P(OnThreads, PlocGivesTheBitsOfTheSequentialOne) {
  const std::vector<Triangle> triangles = random_soup(MANY, 1);
  const Bvh bvh = build_ploc_parallel(triangles, {.threads = GetParam()});
  const Bvh sequential = build_ploc(triangles);
  EXPECT_TRUE(same_nodes(bvh, sequential));
  EXPECT_EQ(bvh.rounds, sequential.rounds);
}

TEST_P(OnThreads, PlocPairsCoincidentTrianglesAlike) {
  const std::vector<Triangle> triangles(20001, Triangle{vec3(1, 2, 3), vec3(2, 2, 3), vec3(1, 3, 4)});
  const Bvh bvh = build_ploc_parallel(triangles, {.radius = 100, .threads = GetParam()});
  EXPECT_TRUE(same_nodes(bvh, build_ploc(triangles, {.radius = 100})));
  EXPECT_EQ(bvh.rounds, 15u);
}

TEST_P(OnThreads, LbvhGivesTheSameBits) {
  const std::vector<Triangle> triangles = random_soup(MANY, 2);
  EXPECT_TRUE(same_nodes(build_lbvh(triangles, {30, GetParam()}), build_lbvh(triangles, {30, 1})));
}

TEST_P(OnThreads, SortIsStable) {
  Random random(3);
  std::vector<std::uint64_t> codes(MANY);
  for (std::uint64_t& code : codes) code = random.below(1000);
  EXPECT_EQ(sorted_order(codes, 30, Threads(GetParam())), sorted_order(codes, 30));
}

TEST_P(OnThreads, InactiveTrianglesAreLeftOut) {
  std::vector<Triangle> triangles = random_soup(MANY, 4);
  for (std::size_t i = 0; i < triangles.size(); i += 7) {
    triangles[i].b.y = std::numeric_limits<float>::quiet_NaN();
  }
  const Bvh bvh = build_lbvh(triangles, {30, GetParam()});
  EXPECT_EQ(bvh.active_count, MANY - (MANY + 6) / 7);
  expect_valid(bvh, triangles);
}

TEST_P(OnThreads, EveryChunkIsVisitedOnce) {
  std::vector<int> visits(1000, 0);
  Threads(GetParam()).for_each_chunk(1000, 7, [&](Chunk chunk, std::size_t k) {
    EXPECT_EQ(chunk.begin, 7 * k);
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) ++visits[i];
  });
  EXPECT_EQ(visits, std::vector<int>(1000, 1));
}

INSTANTIATE_TEST_SUITE_P(Counts, OnThreads, testing::Values(0, 1, 2, 3, 4));

// What a radix tree is: each node splits where the highest bit of (code, place) changes.
TEST(BuildLbvh, SplitsWhereTheHighestBitOfTheCodesChanges) {
  const std::vector<Triangle> triangles = random_soup(3000, 5);
  const Bvh bvh = build_lbvh(triangles, {60, 2});
  const MortonLeaves leaves = make_morton_leaves(triangles, 60, Threads(1));
  struct Run {
    std::uint32_t node;
    std::size_t first, last;
  };
  std::vector<Run> stack = {{0, 0, leaves.count() - 1}};
  while (!stack.empty()) {
    const auto [index, first, last] = stack.back();
    stack.pop_back();
    const Node& node = bvh.nodes[index];
    if (first == last) {
      ASSERT_EQ(node.height, 0u);
      ASSERT_EQ(node.child, leaves.leaf(first).child);
      continue;
    }
    const std::uint64_t bits = leaves.code(first) ^ leaves.code(last);
    ASSERT_NE(bits, 0u) << "codes of 60 bits tell these triangles apart";
    std::size_t split = first;
    while (std::bit_width(leaves.code(first) ^ leaves.code(split + 1)) < std::bit_width(bits)) ++split;
    stack.push_back({node.child, first, split});
    stack.push_back({node.child + 1, split + 1, last});
  }
}

TEST(BuildLbvh, HalvesTrianglesOfOneCodeByTheirOrder) {
  const Bvh bvh = build_lbvh(std::vector<Triangle>(1024, Triangle{vec3(0), vec3(1), vec3(2)}));
  EXPECT_EQ(bvh.nodes[0].height, 10u);
}

TEST(BuildLbvh, RefusesMortonCodesOfOtherThan30Or60Bits) {
  EXPECT_THROW(build_lbvh({}, {.morton_bits = 31}), std::invalid_argument);
}

TEST(BuildPlocParallel, RefusesWhatPlocRefuses) {
  EXPECT_THROW(build_ploc_parallel({}, {.radius = 0}), std::invalid_argument);
  EXPECT_THROW(build_ploc_parallel({}, {.morton_bits = 31}), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
