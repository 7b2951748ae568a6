// What a change of the scene does to the tree of the device: see builders_metamorphic_test.cpp.
#include <gtest/gtest.h>

#include "support/device_run.h"
#include "support/metamorphic.h"

namespace coppice {
namespace {

// Enough triangles for rounds before the finish.
constexpr std::uint32_t COUNT = 3000;

class DeviceMetamorphic : public DeviceTest {
 protected:
  static BuiltTree build(const Triangles& triangles) {
    BuildOptions options;
    options.morton_bits = 60;
    BuiltTree tree = build_on(test_device(), triangles, options);
    EXPECT_EQ(tree.nodes.size(), 2 * triangles.size() - 1);
    return tree;
  }
};

TEST_F(DeviceMetamorphic, PowersOfTwoScaleTheBoxesAndKeepTheTree) {
  const Triangles triangles = whole_number_soup(COUNT, 1);
  const BuiltTree tree = build(triangles);
  for (const float factor : {0x1p-126f, 0x1p-40f, 0x1p+1f, 0x1p+116f}) {
    const auto scale = [&](vec3 p) { return p * factor; };
    const BuiltTree scaled = build(mapped(triangles, scale));
    EXPECT_TRUE(same_bits(scaled.nodes, mapped_boxes(tree.nodes, scale))) << factor;
  }
}

TEST_F(DeviceMetamorphic, ExactTranslationsKeepTheTree) {
  const Triangles triangles = whole_number_soup(COUNT, 2);
  const BuiltTree tree = build(triangles);
  for (const vec3 offset : {vec3(-1024, 0, 77), vec3(1 << 20, -(1 << 20), 12345)}) {
    const auto move = [&](vec3 p) { return p + offset; };
    const BuiltTree moved = build(mapped(triangles, move));
    EXPECT_TRUE(same_bits(moved.nodes, mapped_boxes(tree.nodes, move))) << offset.x;
  }
}

TEST_F(DeviceMetamorphic, ShufflesKeepTheTreeWhereNoCodesTie) {
  const Triangles triangles = sparse_soup(COUNT, 3);
  ASSERT_FALSE(has_equal_codes(triangles, 60));
  const Shuffled other = shuffled(triangles, 1);
  const BuiltTree tree = build(triangles), after = build(other.triangles);
  EXPECT_FALSE(same_bits(after.nodes, tree.nodes));
  EXPECT_TRUE(same_bits(with_old_names(after.nodes, other), tree.nodes));
}

TEST_F(DeviceMetamorphic, DoubledTrianglesCostOneRound) {
  const Triangles triangles = sparse_soup(COUNT, 4);
  ASSERT_FALSE(has_equal_codes(triangles, 60));
  const BuiltTree once = build(triangles), twice = build(doubled(triangles));
  EXPECT_EQ(twice.state.round_count, once.state.round_count + 1);
  EXPECT_LE(twice.state.round_count, twice.rounds_bound);
  EXPECT_TRUE(sorted_boxes(twice.nodes) == sorted_boxes(once.nodes, true));
}

}  // namespace
}  // namespace coppice
