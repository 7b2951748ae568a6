#include "twins/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "twins/texel_place.h"
#include "twins/vectors.h"

namespace coppice::twins {
namespace {

struct TextureLevelWords {
  std::size_t first;
  uint width, height;
};

TextureLevelWords words_of_level(const TextureHeader& header, uint level) {
  std::size_t first = header.first_word;
  const auto side = [](uint finest, uint at) { return std::max(finest >> at, 1u); };
  for (uint i = 0; i < level; ++i) first += std::size_t{side(header.width, i)} * side(header.height, i);
  return {first, side(header.width, level), side(header.height, level)};
}

class TextureSampler {
 public:
  TextureSampler(const TextureHeader& header, const Address<const uint>& texels,
                 const Address<const float>& linear, vec2 uv)
      : header_(header), texels_(texels), linear_(linear) {
    for (int axis = 0; axis < 2; ++axis) {
      wrap_[axis] = (header.flags >> (axis == 0 ? TEXTURE_WRAP_U_SHIFT : TEXTURE_WRAP_V_SHIFT)) & 3;
      const float product = uv[axis] * header.scale[axis];
      place_[axis] = unit_place(product + header.offset[axis], wrap_[axis]);
    }
  }

  glm::vec4 in_level(uint level) const {
    const TextureLevelWords words = words_of_level(header_, level);
    const float x = place_[0] * static_cast<float>(words.width) - 0.5f;
    const float y = place_[1] * static_cast<float>(words.height) - 0.5f;
    const long left = std::lrint(std::floor(x)), top = std::lrint(std::floor(y));
    const float across = x - std::floor(x), down = y - std::floor(y);
    const auto row = [&](long at) {
      const std::size_t first = words.first + std::size_t{on_axis(at, words.height, wrap_[1])} * words.width;
      return mixed(colour(texels_[first + on_axis(left, words.width, wrap_[0])]),
                   colour(texels_[first + on_axis(left + 1, words.width, wrap_[0])]), across);
    };
    return mixed(row(top), row(top + 1), down);
  }

  static glm::vec4 mixed(const glm::vec4& first, const glm::vec4& second, float part) {
    glm::vec4 result;
    for (int channel = 0; channel < 4; ++channel) {
      const float step = (second[channel] - first[channel]) * part;
      result[channel] = first[channel] + step;
    }
    return result;
  }

 private:
  glm::vec4 colour(uint texel) const {
    glm::vec4 result;
    for (int channel = 0; channel < 4; ++channel) {
      const uint code = (texel >> (8 * channel)) & 0xff;
      const bool is_code = channel < 3 && (header_.flags & TEXTURE_COLOUR) != 0;
      result[channel] = is_code ? linear_[code] : static_cast<float>(code) * 0.003921569f;
    }
    return result;
  }

  const TextureHeader header_;
  const Address<const uint>& texels_;
  const Address<const float>& linear_;
  std::array<uint, 2> wrap_;
  std::array<float, 2> place_;
};

float large_enough(float x) { return std::fabs(x) < 0x1p-60f ? 0 : x; }

}  // namespace

glm::vec4 texture_colour(const Address<const TextureHeader>& headers, const Address<const uint>& texels,
                         const Address<const float>& linear, uint which, vec2 uv, float level) {
  const TextureHeader& header = headers[which];
  const TextureSampler sampler(header, texels, linear, uv);
  float at = level;
  if (!(at > 0x1p-20f)) at = 0;
  if (at >= static_cast<float>(header.levels - 1)) return sampler.in_level(header.levels - 1);
  const auto finer = static_cast<uint>(at);
  const float part = at - static_cast<float>(finer);
  if (part == 0) return sampler.in_level(finer);
  return TextureSampler::mixed(sampler.in_level(finer), sampler.in_level(finer + 1), part);
}

float log2_by_bits(float x) {
  if (!(x >= std::numeric_limits<float>::min())) return -126;
  if (std::isinf(x)) return 128;
  int exponent = 0;
  const float m = std::frexp(x, &exponent) * 2 - 1;
  const float polynomial = LOG2_BEND_0 + m * (LOG2_BEND_1 + m * LOG2_BEND_2);
  const float bend = m * (1 - m) * polynomial;
  return static_cast<float>(exponent - 1) + (m + bend);
}

float twice_texcoord_area(const CornerAttributes& corners) {
  const auto edge = [&](vec2 end) {
    return vec2(large_enough(end.x - corners.texcoord_a.x), large_enough(end.y - corners.texcoord_a.y));
  };
  const vec2 b = edge(corners.texcoord_b), c = edge(corners.texcoord_c);
  const float first = b.x * c.y, second = b.y * c.x;
  const float area = std::fabs(first - second);
  return std::isfinite(area) ? area : INFINITY;
}

float twice_area(const Triangle& triangle) {
  const auto edge = [&](const vec3& end) {
    vec3 result;
    for (int axis = 0; axis < 3; ++axis) result[axis] = large_enough(end[axis] - triangle.a[axis]);
    return result;
  };
  const vec3 across = cross_product(edge(triangle.b), edge(triangle.c));
  if (!std::isfinite(across.x) || !std::isfinite(across.y) || !std::isfinite(across.z)) return INFINITY;
  const float largest = std::fmax(std::fmax(std::fabs(across.x), std::fabs(across.y)), std::fabs(across.z));
  if (!(largest >= 7.888609e-31f)) return 0;
  const vec3 scaled(across.x / largest, across.y / largest, across.z / largest);
  return std::sqrt(dot_product(scaled, scaled)) * largest;
}

float cone_width_at(float width, float spread, float distance) {
  const float wider = spread * distance;
  return width + wider;
}

float surface_level(float twice_texcoords, float twice_area, float cone_width, float cosine) {
  const float areas = log2_by_bits(twice_texcoords) - log2_by_bits(twice_area);
  const float widths = log2_by_bits(cone_width) - log2_by_bits(cosine);
  return 0.5f * areas + widths;
}

float texture_level(const TextureHeader& header) {
  const float texels = static_cast<float>(header.width) * static_cast<float>(header.height);
  return 0.5f * log2_by_bits(texels * std::fabs(header.scale.x * header.scale.y));
}

}  // namespace coppice::twins
