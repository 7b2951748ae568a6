// When a benchmark begins to count, and whether it may say that it was stable.
#include "measure/steady_state.h"

#include <gtest/gtest.h>

namespace coppice {
namespace {

TEST(SteadyState, CountsOnlyWhatComesAfterTheWarmUp) {
  int call = 0;
  const auto run = [&] { return ++call <= 7 ? 100.0 - 10 * call : 10.0; };  // slow at first
  const SteadyTime time = measure_steady({.runs = 3, .batch = 5}, run);
  EXPECT_TRUE(time.stable);
  EXPECT_EQ(time.warm_up_runs, 15u);  // medians 70, 10, 10
  EXPECT_EQ(time.runs_ms, (std::vector<double>{10, 10, 10}));
}

TEST(SteadyState, SaysSoWhenItNeverSettles) {
  double ms = 1;
  const SteadyTime time =
      measure_steady({.runs = 2, .batch = 3, .most_warm_up_runs = 12}, [&] { return ms *= 1.2; });
  EXPECT_FALSE(time.stable);
  EXPECT_EQ(time.warm_up_runs, 12u);
  EXPECT_EQ(time.runs_ms.size(), 2u);
}

TEST(SteadyState, EndsALongWarmUpByItsTime) {
  double ms = 1000;
  const SteadyTime time = measure_steady({.runs = 1, .batch = 2}, [&] { return ms *= 1.5; });
  EXPECT_FALSE(time.stable);
  EXPECT_EQ(time.warm_up_runs, 4u);  // after which over 4 s have gone
}

}  // namespace
}  // namespace coppice
