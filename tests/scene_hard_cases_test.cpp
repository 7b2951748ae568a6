// Every hard case is deterministic, of the size asked for, and hard in the way that its name says: ties,
// chains and the range of float here, shapes in scene_hard_shapes_test.cpp.
#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <vector>

#include "builders/leaves.h"
#include "builders/morton_order.h"
#include "builders/normalised_space.h"
#include "scene/hard_cases.h"
#include "support/scenes.h"
#include "support/triangles.h"

namespace coppice {
namespace {

class EveryHardCase : public testing::TestWithParam<HardCase> {};

TEST_P(EveryHardCase, HasExactlyTheTrianglesAskedFor) {
  const HardCase hard_case = GetParam();
  for (const std::uint32_t count :
       {0u, 1u, 2u, 3u, 4u, 5u, 14u, 16u, 257u, hard_case.default_triangle_count}) {
    const Scene scene = hard_case.make(count, 1);
    EXPECT_EQ(scene.indices.size(), hard_case.triangle_count(count));
    if (!hard_case.closed) {
      EXPECT_EQ(scene.indices.size(), count);
    }
    expect_consistent(scene);
  }
}

TEST_P(EveryHardCase, IsAFunctionOfCountAndSeed) {
  for (const std::uint64_t seed : {0ull, 1ull, 7ull, ~0ull})
    EXPECT_TRUE(same_bits(GetParam().make(1000, seed), GetParam().make(1000, seed)));
}

TEST_P(EveryHardCase, HasAUsableCamera) { expect_usable_camera(GetParam().make(1000, 1)); }

INSTANTIATE_TEST_SUITE_P(All, EveryHardCase, testing::ValuesIn(hard_cases().begin(), hard_cases().end()),
                         [](const auto& info) { return test_name(info.param); });

float largest_magnitude(const Scene& scene) {
  float largest = 0;
  for (const glm::vec3 p : scene.positions)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest;
}

TEST(HardCases, AnUnknownNameIsNone) { EXPECT_EQ(find_hard_case("no such case"), nullptr); }

TEST(HardCases, NamesAndDescriptionsAreDistinct) {
  std::map<std::string_view, int> names, descriptions;
  for (const HardCase& hard_case : hard_cases()) {
    EXPECT_EQ(++names[hard_case.name], 1) << hard_case.name;
    EXPECT_EQ(++descriptions[hard_case.description], 1) << hard_case.name;
  }
}

TEST(HardCases, SeedsMatterWhereThereIsRandomness) {
  for (const char* name :
       {"coincident-and-random", "one-cell", "needles", "diagonals", "huge-over-tiny", "dyadic-grid",
        "repeated-indices", "points", "huge", "large", "tiny", "mixed-scales", "room"})
    EXPECT_FALSE(same_bits(make_hard_case(name, 200, 1), make_hard_case(name, 200, 2))) << name;
}

// --- Ties.

TEST(HardCases, NestedBoxesShareTheirCentre) {
  for (const char* name : {"nested", "nested-shells"}) {
    for (const Triangle& t : triangles_of(make_hard_case(name, 300))) {
      const Aabb box = triangle_box(t);
      ASSERT_EQ(box.box_min + box.box_max, vec3(0)) << name;
      ASSERT_GT(box.box_max.x, 0);
    }
  }
}

TEST(HardCases, NestedShellsShareTheirCentroidInFourPlanes) {
  std::map<std::tuple<float, float, float>, int> planes;
  for (const Triangle& t : triangles_of(make_hard_case("nested-shells", 300))) {
    ASSERT_EQ(t.a + t.b + t.c, vec3(0));
    const vec3 normal = glm::cross(t.b - t.a, t.c - t.a);
    const vec3 sides = glm::sign(normal.x * normal);
    ++planes[{sides.x, sides.y, sides.z}];
  }
  ASSERT_EQ(planes.size(), 4u);
  for (const auto& [sides, count] : planes) EXPECT_EQ(count, 75);
}

TEST(HardCases, CoincidentTrianglesAreTheSame) {
  const auto copies = triangles_of(make_hard_case("coincident", 200)),
             half = triangles_of(make_hard_case("coincident-and-random", 200));
  const auto same = [](const Triangle& t, const Triangle& u) {
    return t.a == u.a && t.b == u.b && t.c == u.c;
  };
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_TRUE(same(copies[i], copies[0]));
    EXPECT_EQ(same(half[i], half[0]), i % 2 == 0);
  }
}

// How many triangles are in the fullest cell of the grid of a scene.
std::uint32_t most_in_one_cell(const Scene& scene, int bits_per_axis) {
  std::vector<Aabb> boxes;
  Aabb all{vec3(std::numeric_limits<float>::max()), vec3(std::numeric_limits<float>::lowest())};
  for (const Triangle& t : triangles_of(scene)) all = box_union(all, boxes.emplace_back(triangle_box(t)));
  const NormalisedSpace normalised(all);
  for (Aabb& box : boxes) box = normalised(box);
  std::map<std::uint64_t, std::uint32_t> counts;
  std::uint32_t most = 0;
  for (const std::uint64_t code : morton_codes(boxes, bits_per_axis)) most = std::max(most, ++counts[code]);
  return most;
}

TEST(HardCases, OneCellOf30BitCodesHoldsAlmostAll) {
  for (const std::uint32_t count : {10u, 1000u, 10'000u}) {
    EXPECT_EQ(most_in_one_cell(make_hard_case("one-cell", count), 10), count - 1);
    EXPECT_EQ(most_in_one_cell(make_hard_case("stadium", count), 10), count - 1);
    EXPECT_EQ(most_in_one_cell(make_hard_case("nested", count), 10), count);
  }
  EXPECT_LT(most_in_one_cell(make_hard_case("stadium", 10'000), 20),
            200u);  // longer codes tell the pot's triangles apart
  EXPECT_LT(most_in_one_cell(make_hard_case("far", 10'000), 10), 100u);
}

// --- Chains.

// Half the surface area of the union of the boxes of two triangles, in float as a builder computes it.
float union_area(const std::vector<Triangle>& triangles, std::size_t i, std::size_t j) {
  const Aabb both = box_union(triangle_box(triangles[i]), triangle_box(triangles[j]));
  const vec3 size = both.box_max - both.box_min;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

void expect_each_prefers_the_next(const std::vector<Triangle>& row, const std::string& what) {
  ASSERT_GE(row.size(), 3u);
  for (std::size_t i = 0; i + 2 < row.size(); ++i) {
    const float to_next = union_area(row, i, i + 1);
    ASSERT_GT(to_next, union_area(row, i + 1, i + 2)) << what << " " << i;  // so i + 1 prefers i + 2 to i
    ASSERT_LT(to_next, union_area(row, i, i + 2)) << what << " " << i;      // and i prefers i + 1 to i + 2
  }
}

TEST(HardCases, EachOfARowPrefersTheNext) {
  expect_each_prefers_the_next(triangles_of(make_hard_case("shrinking-gaps", 1'000'000)), "shrinking-gaps");
  for (const std::uint32_t count : {3u, 100u, 10'000u, 60'000u})
    expect_each_prefers_the_next(triangles_of(make_hard_case("geometric-gaps", count)), "geometric-gaps");
}

TEST(HardCases, EachOfAGridPrefersTheNextInItsRow) {
  for (const char* name : {"shrinking-gaps-plane", "geometric-gaps-plane"}) {
    constexpr std::size_t side = 100;
    const auto triangles = triangles_of(make_hard_case(name, side * side));
    for (std::size_t first = 0; first < triangles.size(); first += side) {
      const auto row = triangles.begin() + static_cast<std::ptrdiff_t>(first);
      expect_each_prefers_the_next({row, row + side}, name);
      for (std::size_t i = first; i + 1 < first + side && first + side < triangles.size(); ++i)
        ASSERT_LT(union_area(triangles, i, i + 1), union_area(triangles, i, i + side)) << name << " " << i;
    }
  }
}

double distance(const Triangle& t, const Triangle& u) {
  return glm::length(glm::dvec3(t.a) - glm::dvec3(u.a));
}

TEST(HardCases, AlongASpiralEachOnesNearestIsTheNext) {
  for (const char* name : {"shrinking-gaps-spiral", "geometric-gaps-spiral"}) {
    for (const std::uint32_t count : {10u, 300u, 3000u}) {
      const auto triangles = triangles_of(make_hard_case(name, count));
      for (std::size_t i = 0; i + 1 < count; ++i) {
        const double to_next = distance(triangles[i], triangles[i + 1]);
        for (std::size_t j = 0; j < count; ++j) {
          if (j != i && j != i + 1) {
            ASSERT_GT(distance(triangles[i], triangles[j]), to_next) << name << " " << i << " " << j;
          }
        }
      }
    }
  }
}

TEST(HardCases, GeometricGapsShrinkByOneFactor) {
  for (const char* name : {"geometric-gaps", "geometric-gaps-spiral"}) {
    const auto triangles = triangles_of(make_hard_case(name, 1000));
    const double factor = distance(triangles[1], triangles[2]) / distance(triangles[0], triangles[1]);
    EXPECT_LT(factor, 1);
    for (std::size_t i = 0; i + 2 < triangles.size(); ++i) {
      ASSERT_NEAR(distance(triangles[i + 1], triangles[i + 2]) / distance(triangles[i], triangles[i + 1]),
                  factor, 1e-4)
          << name << " " << i;
    }
    EXPECT_LT(distance(triangles[998], triangles[999]), 1e-6 * distance(triangles[0], triangles[1])) << name;
  }
}

// --- The range of float.

TEST(HardCases, NonFiniteCountsAreAsDescribed) {
  EXPECT_EQ(count_inactive(make_hard_case("non-finite", 1000)), 334u);
  EXPECT_EQ(count_inactive(make_hard_case("all-non-finite", 100)), 100u);
  for (const HardCase& hard_case : hard_cases()) {
    if (hard_case.name.ends_with("non-finite")) continue;
    EXPECT_EQ(count_inactive(hard_case.make(1000, 1)), 0u) << hard_case.name;
  }
}

TEST(HardCases, MagnitudesAreAsDescribed) {
  EXPECT_GT(largest_magnitude(make_hard_case("huge", 1000)), 2.5e38f);
  EXPECT_LT(largest_magnitude(make_hard_case("large", 1000)), 1.2e18f);
  EXPECT_GT(largest_magnitude(make_hard_case("large", 1000)), 0.9e18f);
  EXPECT_LT(largest_magnitude(make_hard_case("tiny", 1000)), 5e-38f);
  std::uint32_t denormal = 0, small = 0, great = 0;
  for (const glm::vec3 p : make_hard_case("tiny", 1000).positions)
    denormal += std::fpclassify(p.x) == FP_SUBNORMAL;
  EXPECT_GT(denormal, 500u);
  for (const glm::vec3 p : make_hard_case("mixed-scales", 1000).positions) {
    small += std::abs(p.x) < 1.2e-20f;
    great += std::abs(p.x) > 1e17f;
  }
  EXPECT_EQ(small, 1500u);
  EXPECT_GT(great, 1450u);
}

TEST(HardCases, HugeAreasOverflowAndLargeVolumesDo) {
  const auto size = [](const char* name) {
    const Triangle t = triangles_of(make_hard_case(name, 1)).front();
    const Aabb box = triangle_box(t);
    return box.box_max - box.box_min;
  };
  const vec3 huge = size("huge"), large = size("large");
  EXPECT_FALSE(std::isfinite(huge.x * huge.y));
  EXPECT_TRUE(std::isfinite(large.x * large.y + large.y * large.z + large.z * large.x));
  EXPECT_FALSE(std::isfinite(large.x * large.y * large.z));
}

TEST(HardCases, FarTerrainsAreWhereTheyShouldBe) {
  for (const glm::vec3 p : make_hard_case("far", 1000).positions)
    EXPECT_LT(glm::distance(p, glm::vec3(148376, 1234, -223423)), 80);
  for (const glm::vec3 p : make_hard_case("farther", 1000).positions) {
    EXPECT_LT(glm::distance(p, glm::vec3(1e7f, 1e7f, -1e7f)), 80);
    EXPECT_EQ(p, glm::round(p));  // an ulp is 1
  }
}

TEST(HardCases, NegativeZeroHasBothZeros) {
  std::uint32_t negative = 0, positive = 0;
  for (const glm::vec3 p : make_hard_case("negative-zero", 1000).positions) {
    negative += p.x == 0 && std::signbit(p.x);
    positive += p.x == 0 && !std::signbit(p.x);
  }
  EXPECT_GT(negative, 500u);
  EXPECT_GT(positive, 500u);
}

}  // namespace
}  // namespace coppice
