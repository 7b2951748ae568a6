#include "builders/morton_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "builders/leaves.h"

namespace coppice {
namespace {

constexpr int DIGIT_BITS = 11;
constexpr std::uint32_t DIGITS = 1u << DIGIT_BITS;

template <class Code>
struct CodeOfPrimitive {
  Code code;
  std::uint32_t primitive;
};

template <class Code>
std::uint32_t digit_of(Code code, int pass) {
  return static_cast<std::uint32_t>(code >> (pass * DIGIT_BITS)) & (DIGITS - 1);
}

// Bit i of a 21-bit number goes to bit 3i.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  x = (x | x << 2) & 0x1249249249249249u;
  return x;
}

template <class Code>
std::vector<std::uint32_t> radix_sorted_order(std::span<const std::uint64_t> codes, int code_bits) {
  const int passes = (code_bits + DIGIT_BITS - 1) / DIGIT_BITS;
  std::vector<CodeOfPrimitive<Code>> from(codes.size());
  std::vector<CodeOfPrimitive<Code>> to(codes.size());
  std::vector<std::array<std::uint32_t, DIGITS>> counts(passes);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    from[i] = {static_cast<Code>(codes[i]), static_cast<std::uint32_t>(i)};
    for (int pass = 0; pass < passes; ++pass) ++counts[pass][digit_of(from[i].code, pass)];
  }
  for (int pass = 0; pass < passes; ++pass) {
    std::uint32_t sum = 0;
    for (std::uint32_t& count : counts[pass]) {
      const std::uint32_t smaller_digits = sum;
      sum += count;
      count = smaller_digits;
    }
    for (const auto& pair : from) to[counts[pass][digit_of(pair.code, pass)]++] = pair;
    from.swap(to);
  }
  std::vector<std::uint32_t> order(codes.size());
  std::transform(from.begin(), from.end(), order.begin(), [](const auto& pair) { return pair.primitive; });
  return order;
}

}  // namespace

std::vector<std::uint64_t> morton_codes(std::span<const Aabb> boxes, int bits_per_axis) {
  std::vector<std::uint64_t> codes(boxes.size(), 0);
  if (boxes.empty()) return codes;
  Aabb scene = boxes.front();
  for (const Aabb& box : boxes) scene = box_union(scene, box);
  const vec3 extent = scene.box_max - scene.box_min;
  const float largest_extent = std::max({extent.x, extent.y, extent.z});
  if (largest_extent == 0.0f) return codes;
  const float cells_per_unit = std::ldexp(1.0f, bits_per_axis - 1 - std::ilogb(largest_extent));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const vec3 centre = (boxes[i].box_min + boxes[i].box_max) * 0.5f;
    const glm::uvec3 cell((centre - scene.box_min) * cells_per_unit);
    codes[i] = spread_bits(cell.x) << 2 | spread_bits(cell.y) << 1 | spread_bits(cell.z);
  }
  return codes;
}

std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> codes, int code_bits) {
  return code_bits <= 32 ? radix_sorted_order<std::uint32_t>(codes, code_bits)
                         : radix_sorted_order<std::uint64_t>(codes, code_bits);
}

}  // namespace coppice
