#pragma once

#include <cstdint>
#include <span>

#include "interface/trace.h"

namespace coppice {

struct ImageDifference {
  std::uint64_t differing_pixels = 0;
  std::uint32_t largest_channel_difference = 0;  // 0 to 255
  double mean_absolute_error = 0.0;              // over all four channels of all pixels, 0 to 255
};

// Of two RGBA8 images of the same size. Throws std::invalid_argument where the sizes differ.
ImageDifference compare_images(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b);

struct HitDifference {
  std::uint64_t count = 0;           // hits that differ in any bit
  std::uint64_t other_triangle = 0;  // of these, in the triangle; a hit against a miss counts
  double largest_relative_t = 0.0;   // |ta - tb| / max(|ta|, |tb|) where both rays hit; infinity for a NaN
};

// Of the hits of the same rays. Throws std::invalid_argument where the lengths differ.
HitDifference compare_hits(std::span<const Hit> a, std::span<const Hit> b);

}  // namespace coppice
