#include "analysis/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace coppice {
namespace {

double relative_difference(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  if (a == b) return 0.0;
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

}  // namespace

ImageDifference compare_images(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  if (a.size() != b.size()) throw std::invalid_argument("compare_images: images of different sizes");
  ImageDifference difference;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    ++difference.differing_pixels;
    for (int shift = 0; shift < 32; shift += 8) {
      const int channel_a = static_cast<int>(a[i] >> shift & 255);
      const int channel_b = static_cast<int>(b[i] >> shift & 255);
      const auto channel_difference = static_cast<std::uint32_t>(std::abs(channel_a - channel_b));
      sum += channel_difference;
      difference.largest_channel_difference =
          std::max(difference.largest_channel_difference, channel_difference);
    }
  }
  if (!a.empty()) {
    difference.mean_absolute_error = static_cast<double>(sum) / (4.0 * static_cast<double>(a.size()));
  }
  return difference;
}

HitDifference compare_hits(std::span<const Hit> a, std::span<const Hit> b) {
  if (a.size() != b.size()) throw std::invalid_argument("compare_hits: different numbers of hits");
  HitDifference difference;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(Hit)) == 0) continue;
    ++difference.count;
    if (a[i].triangle != b[i].triangle) ++difference.other_triangle;
    if (a[i].triangle == NO_TRIANGLE || b[i].triangle == NO_TRIANGLE) continue;
    difference.largest_relative_t =
        std::max(difference.largest_relative_t, relative_difference(a[i].t, b[i].t));
  }
  return difference;
}

}  // namespace coppice
