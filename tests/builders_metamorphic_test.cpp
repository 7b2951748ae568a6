// What a change of the scene does to the tree: which builders commute with it, to the bit, and on what terms.
// docs/numerics.md, "What the tree keeps", says why.
#include <gtest/gtest.h>

#include <string_view>

#include "analysis/quality.h"
#include "analysis/validate.h"
#include "builders/registry.h"
#include "pipeline/build_plan.h"
#include "support/builders.h"
#include "support/metamorphic.h"
#include "support/split_trees.h"
#include "support/triangles.h"

namespace coppice {
namespace {

using BuilderNames = std::vector<std::string_view>;

const BuilderNames WITHOUT_MORTON_ORDER = {"top-down", "bottom-up",  "sah", "sah-sweep",
                                           "gd16",     "gd16-early", "sbvh"};

BuilderNames every_builder() {
  BuilderNames names;
  for (const CpuBuilder& builder : cpu_builders()) {
    if (builder.name != "none") names.push_back(builder.name);
  }
  return names;
}
const BuilderNames EVERY_BUILDER = every_builder();

constexpr std::uint32_t MORTON_BITS = 60;

Bvh build(std::string_view name, const Triangles& triangles, std::uint32_t radius = 16) {
  const Bvh bvh = find_cpu_builder(name).build(triangles, {radius, MORTON_BITS});
  EXPECT_GE(bvh.nodes.size(), 2 * triangles.size() - 1) << name;
  return bvh;
}

// --- Scale

TEST(Metamorphic, PowersOfTwoScaleTheBoxesAndKeepTheTree) {
  const Triangles triangles = split_test_soup(500, 0.5f, 1);
  for (const std::string_view name : EVERY_BUILDER) {
    const Bvh bvh = build(name, triangles);
    EXPECT_EQ(bvh.nodes.size() > 2 * triangles.size() - 1, find_cpu_builder(name).splits_triangles) << name;
    for (const float factor : {0x1p-40f, 0x1p-3f, 0x1p+1f, 0x1p+40f}) {
      const auto scale = [&](vec3 p) { return p * factor; };
      const Bvh scaled = build(name, mapped(triangles, scale));
      EXPECT_TRUE(same_bits(scaled.nodes, mapped_boxes(bvh.nodes, scale))) << name << " by " << factor;
    }
  }
}

// The factor of normalised coordinates takes any unit.
TEST(Metamorphic, PowersOfTwoToTheEndsOfFloatKeepMortonTrees) {
  const Triangles triangles = whole_number_soup(500, 1);
  for (const std::string_view name : {"lbvh", "ploc", "ploc-parallel"}) {
    const Bvh bvh = build(name, triangles);
    for (const float factor : {0x1p-126f, 0x1p+116f}) {
      const auto scale = [&](vec3 p) { return p * factor; };
      const Bvh scaled = build(name, mapped(triangles, scale));
      EXPECT_TRUE(same_bits(scaled.nodes, mapped_boxes(bvh.nodes, scale))) << name << " by " << factor;
    }
  }
}

// --- Translation

TEST(Metamorphic, ExactTranslationsKeepTheTree) {
  const Triangles triangles = whole_number_soup(500, 2);
  for (const std::string_view name : EVERY_BUILDER) {
    const Bvh bvh = build(name, triangles);
    for (const vec3 offset : {vec3(1, 2, 3), vec3(-1024, 0, 77), vec3(1 << 20, -(1 << 20), 12345)}) {
      const auto move = [&](vec3 p) { return p + offset; };
      const Bvh moved = build(name, mapped(triangles, move));
      EXPECT_TRUE(same_bits(moved.nodes, mapped_boxes(bvh.nodes, move))) << name << " by " << offset.x;
    }
  }
}

// --- Mirrors and permutations of axes

vec3 mirrored(vec3 p) { return {-p.x, p.y, p.z}; }
vec3 permuted(vec3 p) { return {p.y, p.z, p.x}; }
vec3 exchanged(vec3 p) { return {p.y, p.x, p.z}; }

template <class Map>
void expect_same_boxes(std::string_view name, const Triangles& triangles, Map map,
                       std::uint32_t radius = 16) {
  const Bvh bvh = build(name, triangles, radius);
  const Bvh turned = build(name, mapped(triangles, map), radius);
  EXPECT_FALSE(same_bits(turned.nodes, bvh.nodes)) << name;
  EXPECT_TRUE(sorted_boxes(turned.nodes) == sorted_boxes(mapped_boxes(bvh.nodes, map))) << name;
}

TEST(Metamorphic, MirrorsKeepTreesWithoutMortonOrder) {
  const Triangles triangles = sparse_soup(500, 3);
  for (const std::string_view name : WITHOUT_MORTON_ORDER) expect_same_boxes(name, triangles, mirrored);
}

TEST(Metamorphic, PermutedAxesKeepTreesWithoutMortonOrder) {
  for (const std::string_view name : WITHOUT_MORTON_ORDER) {
    // Areas must be exact, or the order of their sum is seen. The middle of the longest axis knows no areas,
    // but whole numbers make two axes equally long.
    const Triangles triangles = name == "top-down" ? sparse_soup(500, 4) : whole_number_soup(500, 4);
    expect_same_boxes(name, triangles, permuted);
    expect_same_boxes(name, triangles, exchanged);
  }
}

// Where the search reaches every cluster the order matters only to ties.
TEST(Metamorphic, MirrorsAndPermutedAxesKeepPlocThatSeesAllClusters) {
  const Triangles sparse = sparse_soup(PLOC_MAX_RADIUS, 5);
  const Triangles whole_numbers = whole_number_soup(PLOC_MAX_RADIUS, 6);
  for (const std::string_view name : {"ploc", "ploc-parallel"}) {
    expect_same_boxes(name, sparse, mirrored, PLOC_MAX_RADIUS);
    expect_same_boxes(name, whole_numbers, permuted, PLOC_MAX_RADIUS);
    expect_same_boxes(name, whole_numbers, exchanged, PLOC_MAX_RADIUS);
  }
}

// Elsewhere the curve runs otherwise, and other neighbours come within reach.
TEST(Metamorphic, MirrorsAndPermutedAxesKeepTheQualityOfMortonTrees) {
  const Triangles triangles = sparse_soup(5000, 7);
  for (const std::string_view name : {"lbvh", "ploc", "ploc-parallel"}) {
    const Bvh bvh = build(name, triangles);
    const double sah = measure_quality(bvh.nodes).sah;
    for (vec3 (*const map)(vec3) : {mirrored, permuted, exchanged}) {
      const Triangles turned_triangles = mapped(triangles, map);
      const Bvh turned = build(name, turned_triangles);
      expect_valid(turned, turned_triangles);
      EXPECT_FALSE(sorted_boxes(turned.nodes) == sorted_boxes(mapped_boxes(bvh.nodes, map))) << name;
      EXPECT_NEAR(measure_quality(turned.nodes).sah, sah, 0.05 * sah) << name;
    }
  }
}

// --- Order in the file

TEST(Metamorphic, ShufflesKeepMortonTreesToTheBit) {
  const Triangles triangles = sparse_soup(5000, 8);
  ASSERT_FALSE(has_equal_codes(triangles, MORTON_BITS));
  const Shuffled other = shuffled(triangles, 1);
  for (const std::string_view name : {"lbvh", "ploc", "ploc-parallel"}) {
    const Bvh bvh = build(name, triangles), after = build(name, other.triangles);
    EXPECT_FALSE(same_bits(after.nodes, bvh.nodes)) << name;
    EXPECT_TRUE(same_bits(with_old_names(after.nodes, other), bvh.nodes)) << name;
  }
}

// Where codes tie, the file decides.
TEST(Metamorphic, ShufflesMayChangeMortonTreesWhoseCodesTie) {
  Triangles triangles = sparse_soup(5000, 8);
  triangles.push_back({vec3(1e7f), vec3(1e7f), vec3(1e7f)});
  ASSERT_TRUE(has_equal_codes(triangles, MORTON_BITS));
  const Triangles other = shuffled(triangles, 1).triangles;
  EXPECT_FALSE(sorted_boxes(build("ploc", other).nodes) == sorted_boxes(build("ploc", triangles).nodes));
}

TEST(Metamorphic, ShufflesKeepTheBoxesOfAllThatDoNotGoByTheList) {
  const Triangles triangles = sparse_soup(500, 9);
  const Shuffled other = shuffled(triangles, 2);
  for (const std::string_view name : WITHOUT_MORTON_ORDER) {
    const Bvh bvh = build(name, triangles), after = build(name, other.triangles);
    EXPECT_EQ(sorted_boxes(after.nodes) == sorted_boxes(bvh.nodes), name != "bottom-up") << name;
  }
}

// --- Every triangle twice

TEST(Metamorphic, DoubledTrianglesMakeValidTrees) {
  for (const Triangles& triangles : {sparse_soup(700, 10), random_soup(700, 11)}) {
    const Triangles twice = doubled(triangles);
    for (const std::string_view name : EVERY_BUILDER) {
      const Bvh bvh = build(name, twice);
      const bool splits = find_cpu_builder(name).splits_triangles;
      EXPECT_EQ(find_fault(bvh.nodes, twice, {splits, !splits}), std::nullopt) << name;
      EXPECT_EQ(bvh.active_count, twice.size()) << name;
      EXPECT_LE(bvh.rounds, ploc_rounds_bound(bvh.active_count, 1)) << name;
    }
  }
}

// The first round merges the copies, since no union is smaller, and the rest is as before.
TEST(Metamorphic, DoubledTrianglesCostPlocOneRound) {
  const Triangles triangles = sparse_soup(700, 12);
  ASSERT_FALSE(has_equal_codes(triangles, MORTON_BITS));
  for (const std::string_view name : {"ploc", "ploc-parallel"}) {
    const Bvh once = build(name, triangles), twice = build(name, doubled(triangles));
    EXPECT_EQ(twice.rounds, once.rounds + 1) << name;
    EXPECT_EQ(twice.nodes[0].height, once.nodes[0].height + 1) << name;
    EXPECT_TRUE(sorted_boxes(twice.nodes) == sorted_boxes(once.nodes, true)) << name;
  }
}

}  // namespace
}  // namespace coppice
