// What all builders that split triangles promise.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <tuple>

#include "analysis/quality.h"
#include "builders/gd16.h"
#include "builders/sbvh.h"
#include "support/floor.h"
#include "support/split_trees.h"

namespace coppice {
namespace {

constexpr ReferenceCap NO_SPARE{.per_triangle = 1.0, .constant = 0};

struct SplitBuilder {
  const char* name;
  Bvh (*build)(std::span<const Triangle> triangles, const ReferenceCap& cap, std::uint32_t threads);
};

void PrintTo(const SplitBuilder& builder, std::ostream* out) { *out << builder.name; }

using Triangles = std::span<const Triangle>;
const SplitBuilder SPLIT_BUILDERS[] = {
    {"gd16",
     [](Triangles triangles, const ReferenceCap& cap, std::uint32_t threads) {
       return build_gd16(triangles, {.reference_cap = cap, .threads = threads});
     }},
    {"gd16_early",
     [](Triangles triangles, const ReferenceCap& cap, std::uint32_t threads) {
       return build_gd16(triangles, {.reference_cap = cap, .early_termination = true, .threads = threads});
     }},
    {"sbvh",
     [](Triangles triangles, const ReferenceCap& cap, std::uint32_t threads) {
       return build_sbvh(triangles, {.reference_cap = cap, .threads = threads});
     }},
};

std::string name_of_builder(const testing::TestParamInfo<SplitBuilder>& info) { return info.param.name; }

class SpatialSplits : public testing::TestWithParam<SplitBuilder> {
 protected:
  static Bvh build(Triangles triangles, const ReferenceCap& cap = {}, std::uint32_t threads = 0) {
    return GetParam().build(triangles, cap, threads);
  }
};

TEST_P(SpatialSplits, GiveNoNodesForNoTriangles) {
  const Bvh bvh = build({});
  EXPECT_TRUE(bvh.nodes.empty());
  EXPECT_EQ(bvh.references, 0u);
}

TEST_P(SpatialSplits, MakeOneTriangleTheRoot) {
  const std::vector<Triangle> triangles = needles(1, 1);
  const Bvh bvh = build(triangles);
  ASSERT_EQ(bvh.nodes.size(), 1u);
  expect_valid_split_tree(bvh, triangles);
}

TEST_P(SpatialSplits, LeaveInactiveTrianglesOut) {
  for (const float odd : {std::numeric_limits<float>::quiet_NaN(), INFINITE, -INFINITE}) {
    std::vector<Triangle> triangles = split_test_soup(50, 0.1f, 2);
    triangles[17].b.y = odd;
    const Bvh bvh = build(triangles);
    EXPECT_EQ(bvh.active_count, 49u);
    expect_valid_split_tree(bvh, triangles);
  }
}

TEST_P(SpatialSplits, LoseNoPointOfATriangle) {
  const std::vector<Triangle> triangles = needles(2000, 3);
  const Bvh bvh = build(triangles);
  ASSERT_GT(bvh.references, 2500u);
  expect_no_point_lost(bvh, triangles);
}

TEST_P(SpatialSplits, StayWithinTheReferenceCap) {
  const std::vector<Triangle> triangles = needles(1000, 4);
  for (const double per_triangle : {1.0, 1.1, 1.5, 3.0}) {
    const Bvh bvh = build(triangles, {per_triangle, 7});
    EXPECT_LE(static_cast<double>(bvh.references), 1000 * per_triangle + 7);
    expect_valid_split_tree(bvh, triangles);
  }
}

TEST_P(SpatialSplits, ReportThatTheCapWasReached) {
  EXPECT_TRUE(build(needles(1000, 5), NO_SPARE).reference_cap_reached);
}

TEST_P(SpatialSplits, ReportNoCapThatWasNotReached) {
  std::vector<Triangle> apart;
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<float>(2 * i);
    apart.push_back({vec3(x, 0, 0), vec3(x + 1, 0, 0), vec3(x, 1, 1)});
  }
  EXPECT_FALSE(build(apart, NO_SPARE).reference_cap_reached);
}

TEST_P(SpatialSplits, RefuseACapBelowOneReferenceATriangle) {
  EXPECT_THROW(build({}, {0.99, 1000}), std::invalid_argument);
  EXPECT_THROW(build({}, {std::numeric_limits<double>::quiet_NaN(), 0}), std::invalid_argument);
}

TEST_P(SpatialSplits, CutTheCostOfNeedles) {
  const std::vector<Triangle> triangles = needles(3000, 6);
  const double whole = measure_quality(build(triangles, NO_SPARE).nodes).sah;
  const ReferenceCap ample{.per_triangle = 5.0, .constant = 0};
  EXPECT_LT(measure_quality(build(triangles, ample).nodes).sah, 0.6 * whole);
}

TEST_P(SpatialSplits, GiveTheSameTreeOnAnyNumberOfThreads) {
  const std::vector<Triangle> triangles = needles(20000, 7);
  const Bvh bvh = build(triangles, {}, 1);
  for (const std::uint32_t threads : {2u, 3u, 8u}) {
    const Bvh other = build(triangles, {}, threads);
    expect_same_nodes(other, bvh);
    EXPECT_EQ(other.reference_cap_reached, bvh.reference_cap_reached);
  }
}

TEST_P(SpatialSplits, OfASoupAreAValidTreeWithNoPointLost) {
  for (const std::uint32_t count : {2, 3, 4, 5, 33, 1000, 5000}) {
    const std::vector<Triangle> triangles = split_test_soup(count, 0.5f, count);
    const Bvh bvh = build(triangles);
    EXPECT_EQ(bvh.active_count, count);
    expect_valid_split_tree(bvh, triangles);
    expect_no_point_lost(bvh, triangles);
  }
}

INSTANTIATE_TEST_SUITE_P(Builders, SpatialSplits, testing::ValuesIn(SPLIT_BUILDERS), name_of_builder);

class SpatialSplitsOfHardCase : public testing::TestWithParam<std::tuple<SplitBuilder, HardCase>> {};

TEST_P(SpatialSplitsOfHardCase, AreAValidTree) {
  const auto& [builder, hard_case] = GetParam();
  const std::vector<Triangle> triangles = hard_triangles(hard_case);
  const Bvh bvh = builder.build(triangles, {}, 0);
  expect_valid_split_tree(bvh, triangles);
  EXPECT_LE(bvh.nodes.empty() ? 0 : bvh.nodes[0].height, REFERENCE_TREE_MAX_HEIGHT);
}

INSTANTIATE_TEST_SUITE_P(Builders, SpatialSplitsOfHardCase,
                         testing::Combine(testing::ValuesIn(SPLIT_BUILDERS),
                                          testing::ValuesIn(hard_cases().begin(), hard_cases().end())),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + ("_" + name_of(std::get<1>(info.param)));
                         });

}  // namespace
}  // namespace coppice
