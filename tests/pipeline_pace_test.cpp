// The work of submits follows what the device does in the time it may have.
#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/pace.h"

namespace coppice {
namespace {

constexpr double target_ms = 200;

// A device that does so much work in a ms, and takes so long for a submit besides.
double ms_of(std::uint64_t work, double per_ms, double overhead_ms = 0.1) {
  return overhead_ms + static_cast<double>(work) / per_ms;
}

void submit(Pace& pace, double per_ms, int times) {
  for (int i = 0; i < times; ++i) pace.note(pace.work(), ms_of(pace.work(), per_ms));
}

TEST(Pace, ReachesItsTargetOnFastAndSlowDevicesWithoutOvershooting) {
  for (const double per_ms : {1.0, 50.0, 5000.0, 1e6, 1e9}) {
    Pace pace(target_ms, 64);
    for (int i = 0; i < 30; ++i) {
      const double ms = ms_of(pace.work(), per_ms);
      EXPECT_LE(ms, 1.5 * target_ms) << per_ms;
      pace.note(pace.work(), ms);
    }
    EXPECT_NEAR(ms_of(pace.work(), per_ms), target_ms, 0.1 * target_ms) << per_ms;
  }
}

TEST(Pace, ASlowerPartShrinksTheNextSubmitAtOnce) {
  Pace pace(target_ms, 4096);
  submit(pace, 5000, 10);
  submit(pace, 100, 1);
  EXPECT_LE(ms_of(pace.work(), 100), 1.1 * target_ms);
}

TEST(Pace, OneFastSubmitDoesNotMakeTheNextHuge) {
  Pace pace(target_ms, 4096);
  submit(pace, 1000, 10);
  submit(pace, 1e9, 1);
  EXPECT_LE(ms_of(pace.work(), 1000), 10 * target_ms);
}

TEST(Pace, TheSmallRestOfATraceSaysNothingUnlessItTookTooLong) {
  Pace pace(target_ms, 4096);
  submit(pace, 5000, 10);
  const std::uint64_t before = pace.work();
  pace.note(128, 3);
  EXPECT_EQ(pace.work(), before);
  pace.note(128, 2 * target_ms);
  EXPECT_LE(pace.work(), 64u);
}

TEST(Pace, RecoversFromASubmitThatCompiled) {
  Pace pace(target_ms, 4096);
  pace.note(4096, 2000);
  submit(pace, 5000, 20);
  EXPECT_GE(ms_of(pace.work(), 5000), 0.8 * target_ms);
}

TEST(Pace, NeverWithoutWorkNorBeyondItsBounds) {
  Pace pace(target_ms, 1);
  pace.note(1, 1e12);
  EXPECT_GE(pace.work(), 1u);
  for (int i = 0; i < 100; ++i) pace.note(pace.work(), 0);
  EXPECT_LE(pace.work(), std::uint64_t{1} << 60);
}

}  // namespace
}  // namespace coppice
