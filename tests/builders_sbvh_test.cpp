#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "builders/sbvh.h"
#include "support/split_trees.h"

namespace coppice {
namespace {

TEST(BuildSbvh, SplitsNothingWhereNoOverlapIsLargeEnough) {
  const Bvh bvh = build_sbvh(needles(1000, 5), {.overlap_threshold = 1.0});
  EXPECT_EQ(bvh.references, 1000u);
  EXPECT_FALSE(bvh.reference_cap_reached);
}

TEST(BuildSbvh, RefusesAThresholdOutOfRange) {
  EXPECT_THROW(build_sbvh({}, {.overlap_threshold = -1.0}), std::invalid_argument);
  EXPECT_THROW(build_sbvh({}, {.overlap_threshold = std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

}  // namespace
}  // namespace coppice
