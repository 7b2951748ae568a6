// gpu-hploc and gpu-lbvh: kernel and twin give the same bits, and the tree is that of the independent CPU
// builder.
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/tree_hash.h"
#include "analysis/validate.h"
#include "builders/hploc.h"
#include "builders/lbvh.h"
#include "interface/hploc.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "support/device_run.h"
#include "support/lockstep.h"

namespace coppice {
namespace {

class HplocBuild : public DeviceTest, public testing::WithParamInterface<DeviceBuilder> {
 protected:
  static BuildOptions options(std::uint32_t radius = 8, std::uint32_t bits = 30) {
    BuildOptions options;
    options.builder = GetParam();
    options.radius = radius;
    options.morton_bits = bits;
    return options;
  }

  static Bvh build_on_cpu(std::span<const Triangle> triangles, const BuildOptions& options) {
    if (options.builder == DeviceBuilder::lbvh) {
      return build_lbvh(triangles, {.morton_bits = options.morton_bits});
    }
    return build_hploc(triangles, {options.radius, options.morton_bits});
  }

  static void expect_tree_of_the_cpu_builder(std::span<const Triangle> triangles, const BuildOptions& options,
                                             const std::string& what) {
    const BuiltTree tree = build_on(test_device(), triangles, options, 3);
    const Bvh bvh = build_on_cpu(triangles, options);
    EXPECT_EQ(tree_hash(tree.nodes), tree_hash(bvh.nodes)) << what;
    EXPECT_EQ(tree.state.active_count, bvh.active_count) << what;
    EXPECT_EQ(find_fault(tree.nodes, triangles), std::nullopt) << what;
    if (!tree.nodes.empty()) {
      EXPECT_LE(tree.nodes[0].height, HPLOC_MAX_HEIGHT) << what;
    }
  }
};

TEST_P(HplocBuild, SizesUpTo300InLockstep) {
  for (std::uint32_t size = 0; size <= 300; ++size) {
    expect_build_in_lockstep(random_triangles(size, size), options(), std::to_string(size) + " triangles");
  }
}

TEST_P(HplocBuild, PowersOfTwoAndTheirNeighboursInLockstep) {
  for (std::uint32_t exponent = 9; exponent <= 16; ++exponent) {
    for (const std::uint32_t size : {(1u << exponent) - 1, 1u << exponent, (1u << exponent) + 1}) {
      expect_build_in_lockstep(random_triangles(size, size), options(), std::to_string(size) + " triangles");
    }
  }
}

TEST_P(HplocBuild, EveryHardCaseInLockstep) {
  for (const HardCase& hard_case : hard_cases()) {
    const std::uint32_t count = std::min(hard_case.default_triangle_count, 20000u);
    expect_build_in_lockstep(scene_arrays(hard_case.make(count, 1)).triangles, options(),
                             std::string(hard_case.name));
  }
}

TEST_P(HplocBuild, NoneToFiveTrianglesAsTheCpuBuilder) {
  for (std::uint32_t count = 0; count <= 5; ++count) {
    expect_tree_of_the_cpu_builder(random_triangles(count, count), options(),
                                   std::to_string(count) + " triangles");
  }
}

TEST_P(HplocBuild, EveryRadiusAndCodeLengthAsTheCpuBuilder) {
  const std::vector<Triangle> triangles = random_triangles(20000, 3);
  for (const std::uint32_t radius : {1u, 2u, 8u, 16u, 100u}) {
    for (const std::uint32_t bits : {30u, 60u}) {
      expect_tree_of_the_cpu_builder(
          triangles, options(radius, bits),
          "radius " + std::to_string(radius) + ", " + std::to_string(bits) + " bits");
    }
  }
}

TEST_P(HplocBuild, EveryHardCaseAsTheCpuBuilder) {
  for (const HardCase& hard_case : hard_cases()) {
    const std::uint32_t count = std::min(hard_case.default_triangle_count, 20000u);
    expect_tree_of_the_cpu_builder(scene_arrays(hard_case.make(count, 1)).triangles, options(),
                                   std::string(hard_case.name));
  }
}

TEST_P(HplocBuild, HalfAMillionTrianglesTheSameOnEveryRun) {
  expect_tree_of_the_cpu_builder(random_triangles(500000, 4), options(), "half a million");
}

class HplocHeight : public DeviceTest {};

// Boxes within boxes: each merge adds one to the same cluster, until clusters pair whatever their distance.
TEST_F(HplocHeight, ChainsEndAboveTheTallOnes) {
  const auto triangles = scene_arrays(find_hard_case("nested")->make(20000, 1)).triangles;
  BuildOptions options;
  options.builder = DeviceBuilder::hploc;
  const BuiltTree tree = build_on(test_device(), triangles, options);
  EXPECT_GT(tree.nodes[0].height, HPLOC_TALL);
  EXPECT_LE(tree.nodes[0].height, HPLOC_MAX_HEIGHT);
}

INSTANTIATE_TEST_SUITE_P(Builders, HplocBuild, testing::Values(DeviceBuilder::hploc, DeviceBuilder::lbvh),
                         [](const auto& info) {
                           return info.param == DeviceBuilder::hploc ? "hploc" : "lbvh";
                         });

}  // namespace
}  // namespace coppice
