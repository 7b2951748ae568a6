// When a refined picture ends, and what it takes from pass to pass. No outcome depends on a clock.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "measure/refine.h"
#include "stages/stages.h"

namespace coppice {
namespace {

struct Went {
  Refined refined;
  std::vector<std::uint32_t> passes;  // samples of each
};

// Passes of which each sample takes so many seconds, of a picture whose error falls from `error_of_one`.
Went went(const RefineLimits& limits, double seconds_a_sample, double error_of_one) {
  Went went;
  std::uint32_t next = 0;
  went.refined = refine(
      limits,
      [&](std::uint32_t first, std::uint32_t end) {
        EXPECT_EQ(first, next);
        EXPECT_LT(first, end);
        next = end;
        went.passes.push_back(end - first);
        return seconds_a_sample * (end - first);
      },
      [&](std::uint32_t samples) {
        EXPECT_GE(samples, 2u);
        return error_of_one / std::sqrt(samples);
      });
  EXPECT_EQ(went.refined.samples, next);
  return went;
}

TEST(Refine, OnePassAtLeast) {
  const Went one = went({.seconds = 1e-9}, 1, 1);
  EXPECT_EQ(one.passes, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(one.refined.ended_by, RefineEnd::seconds);
  EXPECT_TRUE(std::isinf(one.refined.error));
  EXPECT_EQ(went({.error = 100}, 1, 1).refined.samples, REFINE_LEAST_SAMPLES);
}

TEST(Refine, EndsWithinASampleOfItsTime) {
  for (const double seconds_a_sample : {0.001, 0.3, 0.7}) {
    const Went timed = went({.seconds = 10}, seconds_a_sample, 1);
    EXPECT_EQ(timed.refined.ended_by, RefineEnd::seconds);
    EXPECT_GE(timed.refined.seconds, 10 - 1e-9);
    EXPECT_LT(timed.refined.seconds, 10 + seconds_a_sample + 1e-9);
    EXPECT_LT(timed.passes.size(), 20u);
  }
}

TEST(Refine, ReachesAnErrorWithoutGoingFarBeyond) {
  for (const double target : {0.1, 0.03, 0.01}) {
    const Went to_error = went({.error = target}, 1, 1);
    EXPECT_EQ(to_error.refined.ended_by, RefineEnd::error);
    EXPECT_LE(to_error.refined.error, target);
    const double needed = 1 / (target * target);
    EXPECT_LE(to_error.refined.samples, needed + 2);
    EXPECT_LT(to_error.passes.size(), 14u);
  }
}

TEST(Refine, TakesNoMoreSamplesThanItMay) {
  const Went few = went({.error = 1e-6, .most_samples = 100}, 1, 1);
  EXPECT_EQ(few.refined.samples, 100u);
  EXPECT_EQ(few.refined.ended_by, RefineEnd::samples);
  EXPECT_EQ(went({.seconds = 1e9, .most_samples = 1}, 1, 1).refined.samples, 1u);
  EXPECT_EQ(went({.error = 1e9, .most_samples = 3}, 1, 1).refined.samples, 3u);
}

TEST(Refine, WhicheverLimitComesFirst) {
  EXPECT_EQ(went({.seconds = 50, .error = 0.01}, 1, 1).refined.ended_by, RefineEnd::seconds);
  EXPECT_EQ(went({.seconds = 1e6, .error = 0.1}, 1, 1).refined.ended_by, RefineEnd::error);
}

// An error of nothing, or one that does not fall, ends all the same.
TEST(Refine, EndsWhateverTheErrorIs) {
  EXPECT_EQ(went({.error = 0.01}, 1, 0).refined.samples, REFINE_LEAST_SAMPLES);
  const Refined stuck = refine(
      {.error = 0.01, .most_samples = 5000}, [](auto, auto) { return 0.0; },
      [](auto) { return std::numeric_limits<double>::infinity(); });
  EXPECT_EQ(stuck.samples, 5000u);
  EXPECT_EQ(stuck.ended_by, RefineEnd::samples);
}

// --- The points of the sequence.

std::vector<std::pair<float, float>> sequence_points(std::uint32_t count) {
  Film film{};
  film.width = film.height = 1;
  film.right = {1, 0, 0};
  film.down = {0, 1, 0};
  film.is_sequence = 1;
  std::vector<std::pair<float, float>> found;
  for (std::uint32_t i = 0; i < count; ++i) {
    Ray ray{};
    Hit hit{};
    CameraRaysArgs args{};
    args.film.value = reinterpret_cast<std::uint64_t>(&film);
    args.rays.value = reinterpret_cast<std::uint64_t>(&ray);
    args.hits.value = reinterpret_cast<std::uint64_t>(&hit);
    args.ray_count = 1;
    args.sample_index = i;
    film.samples = 1 + i % 7;  // does not matter
    twins::camera_rays(args);
    found.emplace_back(ray.direction.x, ray.direction.y);
  }
  return found;
}

TEST(SampleSequence, BeginsInTheCentre) { EXPECT_EQ(sequence_points(1)[0], std::pair(0.5f, 0.5f)); }

// A (0,2)-sequence: of every aligned 2^k points there is one in each elementary interval of that area.
TEST(SampleSequence, FillsEveryElementaryIntervalOnce) {
  const auto all = sequence_points(1024);
  for (int k = 0; k <= 10; ++k) {
    for (std::uint32_t first = 0; first < all.size(); first += 1u << k) {
      for (int across = 0; across <= k; ++across) {
        std::set<std::pair<int, int>> cells;
        for (std::uint32_t i = first; i < first + (1u << k); ++i)
          cells.insert({static_cast<int>(std::ldexp(all[i].first, across)),
                        static_cast<int>(std::ldexp(all[i].second, k - across))});
        ASSERT_EQ(cells.size(), 1u << k) << first << ", " << across << " of " << k;
      }
    }
  }
}

}  // namespace
}  // namespace coppice
