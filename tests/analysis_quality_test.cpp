#include <gtest/gtest.h>

#include <vector>

#include "analysis/quality.h"

namespace coppice {
namespace {

TEST(MeasureQuality, IsZeroForAnEmptyTree) {
  const TreeQuality quality = measure_quality({});
  EXPECT_EQ(quality.nodes, 0u);
  EXPECT_EQ(quality.leaves, 0u);
  EXPECT_EQ(quality.references, 0u);
  EXPECT_EQ(quality.depth, 0u);
  EXPECT_EQ(quality.sah, 0.0);
}

TEST(MeasureQuality, IsOneForALoneLeaf) {
  const TreeQuality quality = measure_quality(std::vector<Node>{{vec3(0), 0, vec3(1, 2, 3), 0}});
  EXPECT_EQ(quality.nodes, 1u);
  EXPECT_EQ(quality.leaves, 1u);
  EXPECT_EQ(quality.references, 1u);
  EXPECT_EQ(quality.depth, 0u);
  EXPECT_EQ(quality.sah, 1.0);
}

TEST(MeasureQuality, SumsAreasOverThatOfTheRoot) {
  // Half areas: root 5, two unit cubes of 3 each.
  const std::vector<Node> nodes = {
      {vec3(0), 1, vec3(2, 1, 1), 1}, {vec3(0), 0, vec3(1), 0}, {vec3(1, 0, 0), 1, vec3(2, 1, 1), 0}};
  EXPECT_DOUBLE_EQ(measure_quality(nodes).sah, 1.0 + 3.0 / 5.0 + 3.0 / 5.0);
}

TEST(MeasureQuality, CountsInternalNodesAndLeavesAlike) {
  // Half areas: root 7, its children 3 and 5, grandchildren 3 and 3.
  const std::vector<Node> nodes = {{vec3(0), 1, vec3(3, 1, 1), 2},
                                   {vec3(0), 0, vec3(1), 0},
                                   {vec3(1, 0, 0), 3, vec3(3, 1, 1), 1},
                                   {vec3(1, 0, 0), 1, vec3(2, 1, 1), 0},
                                   {vec3(2, 0, 0), 2, vec3(3, 1, 1), 0}};
  const TreeQuality quality = measure_quality(nodes);
  EXPECT_DOUBLE_EQ(quality.sah, 1.0 + 3.0 / 7.0 + 5.0 / 7.0 + 3.0 / 7.0 + 3.0 / 7.0);
  EXPECT_EQ(quality.nodes, 5u);
  EXPECT_EQ(quality.leaves, 3u);
  EXPECT_EQ(quality.depth, 2u);
}

TEST(MeasureQuality, CountsEveryRatioAsOneWhereTheRootHasNoArea) {
  const std::vector<Node> nodes(
      {{vec3(0), 1, vec3(1, 0, 0), 1}, {vec3(0), 0, vec3(0), 0}, {vec3(1, 0, 0), 1, vec3(1, 0, 0), 0}});
  EXPECT_EQ(measure_quality(nodes).sah, 3.0);
}

TEST(MeasureQuality, IsFiniteForBoxesAtTheEndsOfTheRangeOfFloat) {
  const std::vector<Node> nodes = {
      {vec3(-3e38f), 1, vec3(3e38f), 1}, {vec3(-3e38f), 0, vec3(3e38f), 0}, {vec3(0), 1, vec3(1e-38f), 0}};
  EXPECT_DOUBLE_EQ(measure_quality(nodes).sah, 2.0);
}

TEST(MeasureQuality, MeasuresAChainOfAMillionNodes) {
  constexpr std::uint32_t LEAVES = 500000;
  std::vector<Node> nodes = {{vec3(0), 1, vec3(1), LEAVES - 1}};
  for (std::uint32_t i = 1; i < LEAVES; ++i) {
    nodes.push_back({vec3(0), i - 1, vec3(1), 0});
    nodes.push_back({vec3(0), i + 1 < LEAVES ? 2 * i + 1 : LEAVES - 1, vec3(1), LEAVES - 1 - i});
  }
  EXPECT_EQ(measure_quality(nodes).depth, LEAVES - 1);
}

}  // namespace
}  // namespace coppice
