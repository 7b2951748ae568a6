// The tree of the device: valid, the same bits as the independent CPU builder's, within the bound on rounds.
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/tree_hash.h"
#include "analysis/validate.h"
#include "builders/ploc.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/gpu_executor.h"
#include "support/device_run.h"

namespace coppice {
namespace {

class DeviceTree : public DeviceTest {};

void expect_tree_of_the_cpu_builder(std::span<const Triangle> triangles, const BuildOptions& options,
                                    const std::string& what) {
  const BuiltTree tree = build_on(test_device(), triangles, options, 3);
  const Bvh bvh = build_ploc(triangles, {options.radius, options.morton_bits});
  EXPECT_EQ(tree_hash(tree.nodes), tree_hash(bvh.nodes)) << what;
  EXPECT_EQ(tree.state.round_count, bvh.rounds) << what;
  EXPECT_EQ(tree.state.active_count, bvh.active_count) << what;
  EXPECT_LE(tree.state.round_count, tree.rounds_bound) << what;
  if (!tree.nodes.empty()) {
    EXPECT_LE(tree.nodes[0].height, tree.state.round_count) << what;
  }
  EXPECT_EQ(find_fault(tree.nodes, triangles), std::nullopt) << what;
}

TEST_F(DeviceTree, NoneToFiveTriangles) {
  for (std::uint32_t count = 0; count <= 5; ++count) {
    expect_tree_of_the_cpu_builder(random_triangles(count, count), {}, std::to_string(count) + " triangles");
  }
}

TEST_F(DeviceTree, EveryRadiusAndCodeLength) {
  const std::vector<Triangle> triangles = random_triangles(20000, 3);
  for (const std::uint32_t radius : {1u, 2u, 8u, 16u, 100u}) {
    for (const std::uint32_t bits : {30u, 60u}) {
      BuildOptions options;
      options.radius = radius;
      options.morton_bits = bits;
      expect_tree_of_the_cpu_builder(
          triangles, options, "radius " + std::to_string(radius) + ", " + std::to_string(bits) + " bits");
    }
  }
}

TEST_F(DeviceTree, EveryHardCase) {
  for (const HardCase& hard_case : hard_cases()) {
    const std::uint32_t count = std::min(hard_case.default_triangle_count, 20000u);
    expect_tree_of_the_cpu_builder(scene_arrays(hard_case.make(count, 1)).triangles, {},
                                   std::string(hard_case.name));
  }
}

// HIPRT's fallback case: with a naive tie rule one pair merges a round.
TEST_F(DeviceTree, AHundredThousandCopiesOfOneTriangleHalveEveryRound) {
  const auto triangles = scene_arrays(find_hard_case("coincident")->make(100000, 1)).triangles;
  const BuiltTree tree = build_on(test_device(), triangles, {});
  EXPECT_EQ(tree.state.round_count, 17u);
  EXPECT_EQ(tree.nodes[0].height, 17u);
}

TEST_F(DeviceTree, AMillionBoxesWhoseGapsShrinkStayWithinTheBound) {
  const auto triangles = scene_arrays(find_hard_case("shrinking-gaps")->make(1000000, 1)).triangles;
  expect_tree_of_the_cpu_builder(triangles, {}, "shrinking gaps");
}

TEST_F(DeviceTree, WithoutLookbackTheSameTree) {
  const std::vector<Triangle> triangles = random_triangles(60000, 5);
  BuildOptions options;
  const BuiltTree with = build_on(test_device(), triangles, options);
  options.lookback = false;
  const BuiltTree without = build_on(test_device(), triangles, options);
  EXPECT_EQ(tree_hash(with.nodes), tree_hash(without.nodes));
}

TEST_F(DeviceTree, WithoutPollsEveryTileFallsBackToTheSameTree) {
  const std::vector<Triangle> triangles = random_triangles(200000, 6);
  BuildOptions options;
  options.radius = 4;
  const BuiltTree polled = build_on(test_device(), triangles, options);
  options.lookback_turns = 0;
  const BuiltTree unpolled = build_on(test_device(), triangles, options, 5);
  EXPECT_EQ(tree_hash(polled.nodes), tree_hash(unpolled.nodes));
}

TEST_F(DeviceTree, InSeveralBlocksOfMemoryTheSameTree) {
  const std::vector<Triangle> triangles = random_triangles(10000, 9);
  Layout layout(1 << 20);
  const BuildPlan plan = plan_build(layout, 10000, {});
  ASSERT_GT(layout.block_bytes().size(), 1u);
  GpuExecutor executor(test_device(), layout);
  executor.upload(plan.triangles, std::span<const Triangle>(triangles));
  Chain chain = executor.chain();
  append_build(chain, plan);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  EXPECT_EQ(tree_hash(executor.read(plan.nodes)), tree_hash(build_ploc(triangles, {}).nodes));
}

TEST(RoundsBound, IsASmallMultipleOfTheLogarithm) {
  for (std::uint32_t exponent = 1; exponent <= 25; ++exponent) {
    const std::uint32_t bound = ploc_rounds_bound(1u << exponent, 1);
    EXPECT_EQ(bound, PLOC_EPOCH_ROUNDS * exponent + 2) << "2^" << exponent;
  }
}

TEST(BuildPlan, RefusesOptionsOutOfRange) {
  Layout layout;
  BuildOptions options;
  options.radius = 0;
  EXPECT_THROW(plan_build(layout, 10, options), std::invalid_argument);
  options.radius = PLOC_MAX_RADIUS + 1;
  EXPECT_THROW(plan_build(layout, 10, options), std::invalid_argument);
  options = {};
  options.morton_bits = 32;
  EXPECT_THROW(plan_build(layout, 10, options), std::invalid_argument);
  EXPECT_THROW(plan_build(layout, max_triangles + 1, {}), std::invalid_argument);
}

TEST(BuildPlan, NamesTheSlotThatFitsNoBlock) {
  Layout layout(1 << 20);
  try {
    plan_build(layout, 1000000, {});
    FAIL() << "no error";
  } catch (const LayoutError& error) {
    EXPECT_NE(std::string(error.what()).find("'triangles'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace coppice
