#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/texture.h"

namespace coppice {
namespace {

double decoded_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// What of the finer level a texel covers along an axis: up to three texels, in parts of the whole.
struct Taps {
  std::uint32_t first = 0, count = 1;
  std::array<double, 3> weights{1, 0, 0};
};

Taps taps_of(std::uint32_t texel, std::uint32_t finer, std::uint32_t coarser) {
  if (finer == 1) return {};
  if (finer % 2 == 0) return {2 * texel, 2, {0.5, 0.5, 0}};
  const double all = finer, n = coarser, i = texel;
  return {2 * texel, 3, {(n - i) / all, n / all, (i + 1) / all}};
}

class Halving {
 public:
  Halving(const Texture::Level& from, bool is_colour) : from_(from), is_colour_(is_colour) {
    for (int code = 0; code < 256; ++code) {
      colours_[static_cast<std::size_t>(code)] = decoded_srgb(code / 255.0);
      numbers_[static_cast<std::size_t>(code)] = code / 255.0;
      thresholds_[static_cast<std::size_t>(code)] = decoded_srgb((code + 0.5) / 255);
    }
  }

  Texture::Level half() const {
    Texture::Level to{std::max(from_.width / 2, 1u), std::max(from_.height / 2, 1u), {}};
    to.texels.resize(std::size_t{to.width} * to.height);
    tbb::parallel_for(0u, to.height, [&](std::uint32_t y) {
      const Taps rows = taps_of(y, from_.height, to.height);
      for (std::uint32_t x = 0; x < to.width; ++x) {
        to.texels[std::size_t{y} * to.width + x] = average(taps_of(x, from_.width, to.width), rows);
      }
    });
    return to;
  }

 private:
  const std::array<double, 256>& values_of(int channel) const {
    return is_colour_ && channel < 3 ? colours_ : numbers_;
  }

  std::uint32_t average(const Taps& columns, const Taps& rows) const {
    std::array<double, 4> sum{};
    for (std::uint32_t r = 0; r < rows.count; ++r) {
      const std::uint32_t* const row = from_.texels.data() + std::size_t{rows.first + r} * from_.width;
      for (std::uint32_t c = 0; c < columns.count; ++c) {
        const std::uint32_t texel = row[columns.first + c];
        const double weight = rows.weights[r] * columns.weights[c];
        for (int channel = 0; channel < 4; ++channel) {
          sum[static_cast<std::size_t>(channel)] += weight * values_of(channel)[texel >> (8 * channel) & 255];
        }
      }
    }
    std::uint32_t result = 0;
    for (int channel = 0; channel < 4; ++channel) {
      result |= code_of(sum[static_cast<std::size_t>(channel)], channel) << (8 * channel);
    }
    return result;
  }

  std::uint32_t code_of(double value, int channel) const {
    if (!is_colour_ || channel == 3) return static_cast<std::uint32_t>(std::lround(value * 255));
    const auto above = std::upper_bound(thresholds_.begin(), thresholds_.end() - 1, value);
    return static_cast<std::uint32_t>(above - thresholds_.begin());
  }

  const Texture::Level& from_;
  const bool is_colour_;
  std::array<double, 256> colours_, numbers_, thresholds_;  // the last: from where on a code is too small
};

}  // namespace

std::array<float, 256> srgb_to_linear() {
  std::array<float, 256> linear;
  for (std::size_t code = 0; code < 256; ++code) {
    linear[code] = static_cast<float>(decoded_srgb(static_cast<double>(code) / 255));
  }
  return linear;
}

void make_mip_levels(Texture& texture) {
  texture.levels.resize(1);
  while (texture.levels.back().width > 1 || texture.levels.back().height > 1) {
    texture.levels.push_back(Halving(texture.levels.back(), texture.is_colour).half());
  }
}

Texture checker_texture(bool is_colour) {
  constexpr std::uint32_t side = 8, magenta = 0xffff00ff, black = 0xff000000;
  Texture texture;
  texture.is_colour = is_colour;
  Texture::Level& level = texture.levels.emplace_back(Texture::Level{side, side, {}});
  for (std::uint32_t i = 0; i < side * side; ++i) {
    level.texels.push_back((i % side + i / side) % 2 == 0 ? magenta : black);
  }
  make_mip_levels(texture);
  return texture;
}

}  // namespace coppice
