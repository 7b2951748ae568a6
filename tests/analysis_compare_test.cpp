#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "analysis/compare.h"

namespace coppice {
namespace {

using Pixels = std::vector<std::uint32_t>;
using Hits = std::vector<Hit>;

TEST(CompareImages, FindsNoDifferenceBetweenEqualImages) {
  const ImageDifference difference = compare_images(Pixels{1, 2, 3}, Pixels{1, 2, 3});
  EXPECT_EQ(difference.differing_pixels, 0u);
  EXPECT_EQ(difference.largest_channel_difference, 0u);
  EXPECT_EQ(difference.mean_absolute_error, 0.0);
}

TEST(CompareImages, LooksAtEachChannel) {
  const ImageDifference difference =
      compare_images(Pixels{0xff000000, 0xff102030}, Pixels{0xff000000, 0xff112a2d});
  EXPECT_EQ(difference.differing_pixels, 1u);
  EXPECT_EQ(difference.largest_channel_difference, 10u);
  EXPECT_DOUBLE_EQ(difference.mean_absolute_error, (1.0 + 10.0 + 3.0) / 8.0);
}

TEST(CompareImages, TakesEmptyImages) { EXPECT_EQ(compare_images({}, {}).mean_absolute_error, 0.0); }

TEST(CompareImages, RefusesDifferentSizes) {
  EXPECT_THROW(compare_images(Pixels{1}, {}), std::invalid_argument);
}

TEST(CompareHits, FindsNoDifferenceBetweenEqualHits) {
  const Hits hits = {{1, 2, 0.25f, 0.5f}, {std::numeric_limits<float>::infinity(), NO_TRIANGLE, 0, 0}};
  const HitDifference difference = compare_hits(hits, hits);
  EXPECT_EQ(difference.count, 0u);
  EXPECT_EQ(difference.other_triangle, 0u);
  EXPECT_EQ(difference.largest_relative_t, 0.0);
}

TEST(CompareHits, CountsOtherTriangles) {
  const HitDifference difference =
      compare_hits(Hits{{1, 2, 0, 0}, {1, 2, 0, 0}}, Hits{{1, 3, 0, 0}, {1, 2, 1, 0}});
  EXPECT_EQ(difference.count, 2u);
  EXPECT_EQ(difference.other_triangle, 1u);
}

TEST(CompareHits, CountsAHitAgainstAMissButNotItsDistance) {
  const float infinity = std::numeric_limits<float>::infinity();
  const HitDifference difference = compare_hits(Hits{{1, 2, 0, 0}}, Hits{{infinity, NO_TRIANGLE, 0, 0}});
  EXPECT_EQ(difference.other_triangle, 1u);
  EXPECT_EQ(difference.largest_relative_t, 0.0);
}

TEST(CompareHits, RelatesDistancesToTheLargerOne) {
  EXPECT_DOUBLE_EQ(compare_hits(Hits{{3, 0, 0, 0}}, Hits{{4, 0, 0, 0}}).largest_relative_t, 0.25);
}

TEST(CompareHits, FindsANaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compare_hits(Hits{{nan, 0, 0, 0}}, Hits{{4, 0, 0, 0}}).largest_relative_t,
            std::numeric_limits<double>::infinity());
}

TEST(CompareHits, RefusesDifferentLengths) { EXPECT_THROW(compare_hits(Hits(1), {}), std::invalid_argument); }

}  // namespace
}  // namespace coppice
