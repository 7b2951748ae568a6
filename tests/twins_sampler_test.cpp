// The points that paths are sampled by: nets of Sobol's sequence, scrambled anew for each pixel and
// dimension.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "scene/random.h"
#include "twins/sampler.h"

namespace coppice {
namespace {

using twins::sample_1d;
using twins::sample_2d;

constexpr std::array<uint, 4> pixel_seeds = {0, 1, 77777, 0xffffffff};
constexpr std::array<uint, 3> dimensions = {0, 1, 30};

// How many of 2^k parts of the square, 2^columns by 2^(k - columns), have exactly one of the points.
std::size_t parts_with_one(const std::vector<glm::vec2>& points, int columns, int rows) {
  std::vector<int> counts(points.size(), 0);
  for (const glm::vec2& point : points) {
    const auto column = static_cast<std::size_t>(std::ldexp(point.x, columns));
    const auto row = static_cast<std::size_t>(std::ldexp(point.y, rows));
    ++counts[row << columns | column];
  }
  return static_cast<std::size_t>(std::count(counts.begin(), counts.end(), 1));
}

TEST(Sampler, AnyPowerOfTwoOfSamplesIsANet) {
  for (const uint seed : pixel_seeds)
    for (const uint dimension : dimensions)
      for (int k = 0; k <= 10; ++k) {
        std::vector<glm::vec2> points;
        for (uint i = 0; i < 1u << k; ++i) points.push_back(sample_2d(seed, i, dimension));
        for (int columns = 0; columns <= k; ++columns)
          ASSERT_EQ(parts_with_one(points, columns, k - columns), points.size()) << seed << " " << k;
      }
}

// Nets are of blocks, wherever they begin: that lets samples come in passes.
TEST(Sampler, LaterBlocksAreNetsToo) {
  for (uint block = 0; block < 8; ++block) {
    std::vector<glm::vec2> points;
    for (uint i = 0; i < 64; ++i) points.push_back(sample_2d(5, block * 64 + i, 2));
    for (int columns = 0; columns <= 6; ++columns)
      EXPECT_EQ(parts_with_one(points, columns, 6 - columns), 64u);
  }
}

TEST(Sampler, OneNumberIsTheFirstOfTwoAndStratified) {
  for (const uint seed : pixel_seeds)
    for (const uint dimension : dimensions) {
      std::vector<int> counts(256, 0);
      for (uint i = 0; i < 256; ++i) {
        const float x = sample_1d(seed, i, dimension);
        EXPECT_EQ(x, sample_2d(seed, i, dimension).x);
        ++counts[static_cast<std::size_t>(x * 256)];
      }
      EXPECT_EQ(counts, std::vector<int>(256, 1));
    }
}

TEST(Sampler, NumbersAreMultiplesOf2ToTheMinus24BelowOne) {
  for (uint i = 0; i < 100000; ++i) {
    const glm::vec2 point = sample_2d(i * 2654435761u, i, i % 50);
    for (const float x : {point.x, point.y}) {
      ASSERT_TRUE(x >= 0 && x < 1) << x;
      ASSERT_EQ(std::ldexp(x, 24), std::floor(std::ldexp(x, 24)));
    }
  }
}

TEST(Sampler, PixelsAndDimensionsAreUncorrelatedAndUniform) {
  constexpr uint count = 65536;
  using Pair = std::pair<float, float>;
  const std::vector<std::function<Pair(uint)>> draws = {
      [](uint i) -> Pair {
        return {sample_2d(i, 0, 0).x, sample_2d(i, 0, 0).y};
      },
      [](uint i) -> Pair {
        return {sample_2d(i, 3, 0).x, sample_2d(i + 1, 3, 0).x};
      },
      [](uint i) -> Pair {
        return {sample_2d(i, 3, 0).y, sample_2d(i + 640, 3, 0).y};
      },
      [](uint i) -> Pair {
        return {sample_2d(i, 1, 4).x, sample_2d(i, 1, 5).x};
      },
      [](uint i) -> Pair {
        return {sample_2d(i, 1, 4).x, sample_2d(i, 1, 5).y};
      },
      [](uint i) -> Pair {
        return {sample_2d(7, i, 4).x, sample_2d(7, i, 5).x};
      },
      [](uint i) -> Pair {
        return {sample_2d(7, i, 4).y, sample_2d(8, i, 4).y};
      },
  };
  for (std::size_t k = 0; k < draws.size(); ++k) {
    double mean = 0, correlation = 0;
    for (uint i = 0; i < count; ++i) {
      const auto [a, b] = draws[k](i);
      mean += a;
      correlation += 12 * (a - 0.5) * (b - 0.5);
    }
    EXPECT_NEAR(mean / count, 0.5, 4 * std::sqrt(1.0 / 12 / count)) << k;
    EXPECT_NEAR(correlation / count, 0, 4 / std::sqrt(static_cast<double>(count))) << k;
  }
}

// The root mean square error of the mean of a smooth function, over pixels.
template <class Draw>
double error_of_mean(uint samples, Draw draw) {
  constexpr uint pixels = 200;
  const double exact = std::pow(std::exp(1.0) - 1, 2);
  double squares = 0;
  for (uint pixel = 0; pixel < pixels; ++pixel) {
    double sum = 0;
    for (uint i = 0; i < samples; ++i) {
      const glm::vec2 point = draw(pixel, i);
      sum += std::exp(static_cast<double>(point.x) + static_cast<double>(point.y));
    }
    squares += std::pow(sum / samples - exact, 2);
  }
  return std::sqrt(squares / pixels);
}

TEST(Sampler, MeansConvergeFasterThanThoseOfRandomNumbers) {
  const auto net = [](uint pixel, uint i) { return sample_2d(pixel, i, 3); };
  Random random(11);
  const auto independent = [&](uint, uint) {
    const float x = random.uniform(), y = random.uniform();
    return glm::vec2(x, y);
  };
  const double few = error_of_mean(16, net), many = error_of_mean(256, net);
  const double few_random = error_of_mean(16, independent), many_random = error_of_mean(256, independent);
  EXPECT_NEAR(few_random / many_random, 4, 1);  // N^-1/2
  EXPECT_GT(few / many, 24);                    // N^-3/2 would be 64
  EXPECT_LT(few, few_random / 5);
  EXPECT_LT(many, many_random / 40);
}

}  // namespace
}  // namespace coppice
