// A plan made for many primitives is that for any number of fewer, in the same slots.
#include <gtest/gtest.h>

#include "interface/sort.h"
#include "pipeline/build_plan.h"
#include "pipeline/wide_plan.h"

namespace coppice {
namespace {

void expect_room(const BuildPlan& most, std::uint32_t count) {
  const BuildPlan plan = with_count(most, count);
  const SortPlan& sort = plan.sort;
  const std::uint64_t tile_digits = std::uint64_t{sort.tile_count} << sort.digit_bits;
  if (sort.onesweep) {
    EXPECT_LE(sort.passes * tile_digits, most.sort_status.count) << count;
    EXPECT_LE(sort.passes * SORT_DIGITS, most.histogram.count) << count;
  } else {
    EXPECT_LE(tile_digits, most.sort_digits.count) << count;
  }
  EXPECT_EQ(plan.triangle_count, count);
}

TEST(BuildPlan, OfManyHasRoomForAnyNumberOfFewer) {
  constexpr std::uint32_t breaks[] = {1u << 14, 1u << 18, 1u << 24, 1u << 25};  // of tiles and of digits
  for (const SortVariant variant : {SORT_SCAN, SORT_SCAN_8, SORT_SCAN_11, SORT_ONESWEEP_RUNS}) {
    BuildOptions options;
    options.variants.sort = variant;
    for (const std::uint32_t most :
         {1u, 20000u, (1u << 18) + 1, (1u << 24) + 1, 20'000'000u, (1u << 25) + 1}) {
      Layout layout(~std::uint64_t{0});
      const BuildPlan plan = plan_sort(layout, most, options);
      expect_room(plan, most);
      for (const std::uint32_t at : breaks) {
        for (const std::uint32_t count : {at - 1, at, at + 1}) {
          if (count <= most) expect_room(plan, count);
        }
      }
    }
  }
}

TEST(BuildPlan, OfAWideTreeHasFewerLevelsOfFewerLeaves) {
  Layout layout(~std::uint64_t{0});
  BuildPlan build = plan_build(layout, 1000, {});
  const WidePlan wide = plan_wide(layout, build, &build);
  EXPECT_EQ(with_count(wide, 1000).levels_bound, wide.levels_bound);
  EXPECT_EQ(with_count(wide, 1).levels_bound, 1u);
  EXPECT_EQ(with_count(wide, 0).levels_bound, 0u);
}

}  // namespace
}  // namespace coppice
