#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "builders/leaves.h"
#include "builders/morton_order.h"
#include "builders/normalised_space.h"
#include "scene/random.h"

namespace coppice {
namespace {

Aabb point(float x, float y, float z) { return {vec3(x, y, z), vec3(x, y, z)}; }

TEST(MortonCodes, InterleaveXFirst) {
  const std::vector<Aabb> corners = {point(0, 0, 0), point(0, 0, 1), point(0, 1, 0), point(1, 0, 0)};
  const std::vector<std::uint64_t> expected = {0, 1, 2, 4};
  EXPECT_EQ(morton_codes(corners, 1), expected);
}

TEST(MortonCodes, PutBitIOfAnAxisThreeTimesAsHigh) {
  const std::vector<Aabb> points = {point(0, 0, 0), point(1023, 0, 0), point(0, 512, 0), point(0, 0, 1)};
  const std::vector<std::uint64_t> expected = {0, 0x24924924, std::uint64_t{1} << 28, 1};
  EXPECT_EQ(morton_codes(points, 10), expected);
}

TEST(MortonCodes, FillSixtyBits) {
  const float last = 1048575;
  const std::vector<Aabb> points = {point(0, 0, 0), point(last, last, last)};
  const std::vector<std::uint64_t> expected = {0, (std::uint64_t{1} << 60) - 1};
  EXPECT_EQ(morton_codes(points, 20), expected);
}

TEST(MortonCodes, UseCellsOfOneSizeForAllAxes) {
  const std::vector<Aabb> points = {point(0, 0, 0), point(1023, 1, 0), point(0, 1, 0)};
  EXPECT_EQ(morton_codes(points, 10)[2], 2u);
}

TEST(MortonCodes, StartTheGridAtTheSmallestCorner) {
  const std::vector<Aabb> points = {point(-5, 100, 7), point(-5 + 1023, 100, 7)};
  const std::vector<std::uint64_t> expected = {0, 0x24924924};
  EXPECT_EQ(morton_codes(points, 10), expected);
}

TEST(MortonCodes, AreThoseOfTheCentres) {
  const std::vector<Aabb> boxes = {{vec3(0), vec3(1023)}, {vec3(0), vec3(3, 3, 3)}};
  EXPECT_EQ(morton_codes(boxes, 10)[1], 7u);
}

TEST(MortonCodes, AreZeroWithoutExtent) {
  const std::vector<Aabb> points(3, point(4, 5, 6));
  EXPECT_EQ(morton_codes(points, 10), std::vector<std::uint64_t>(3, 0));
}

TEST(MortonCodes, AreNoneForNoBoxes) { EXPECT_TRUE(morton_codes({}, 10).empty()); }

TEST(SortedOrder, IsThatOfAStableSort) {
  for (const int bits : {1, 11, 12, 30, 32, 33, 60, 64}) {
    Random random(bits);
    std::vector<std::uint64_t> codes(5000);
    for (std::uint64_t& code : codes) {
      const std::uint64_t high = random.next();
      code = (high << 32 | random.next()) >> (64 - bits);
    }
    for (std::size_t i = 0; i < 2000; ++i) codes[i] = codes[i + 3000];
    std::vector<std::uint32_t> expected(codes.size());
    std::iota(expected.begin(), expected.end(), 0);
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    EXPECT_EQ(sorted_order(codes, bits), expected) << bits << " bits";
  }
}

TEST(SortedOrder, IsEmptyForNoCodes) { EXPECT_TRUE(sorted_order({}, 30).empty()); }

TEST(NormalisedSpace, PutsTheLargestCoordinateBelowTwoToTheSixty) {
  for (const float largest : {1e-38f, 0.1f, 1.0f, 1.5f, 1e38f, std::numeric_limits<float>::max()}) {
    const Aabb scene{vec3(-largest, 0, 0), vec3(0)};
    const float x = NormalisedSpace(scene)(scene).box_min.x;
    EXPECT_GT(x, -0x1p60f) << largest;
    EXPECT_LE(x, -0x1p59f) << largest;
  }
}

TEST(NormalisedSpace, SetsNegligibleCoordinatesToZero) {
  const NormalisedSpace normalised(Aabb{vec3(0), vec3(0x1p59f)});
  EXPECT_EQ(normalised(vec3(0x1p-40f, -0x1p-40f, 0x1.fffffep-41f)), vec3(0x1p-40f, -0x1p-40f, 0));
}

TEST(NormalisedSpace, TakesASceneAtTheOrigin) {
  EXPECT_EQ(NormalisedSpace(Aabb{vec3(0), vec3(0)})(vec3(0)), vec3(0));
}

TEST(MakeLeaves, GivesEachActiveTriangleItsBox) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Triangle> triangles = {{vec3(0), vec3(1), vec3(nan, 0, 0)},
                                           {vec3(1, 2, 3), vec3(3, 1, 2), vec3(2, 3, 1)}};
  const std::vector<Node> leaves = make_leaves(triangles);
  ASSERT_EQ(leaves.size(), 1u);
  EXPECT_EQ(leaves[0].child, 1u);
  EXPECT_EQ(leaves[0].height, 0u);
  EXPECT_EQ(leaves[0].box_min, vec3(1));
  EXPECT_EQ(leaves[0].box_max, vec3(3));
}

}  // namespace
}  // namespace coppice
