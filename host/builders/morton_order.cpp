#include "builders/morton_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <memory>
#include <utility>

#include "builders/leaves.h"
#include "builders/threads.h"

namespace coppice {
namespace {

constexpr int DIGIT_BITS = 11;
constexpr std::uint32_t DIGITS = 1u << DIGIT_BITS;
constexpr std::size_t BLOCK = 1 << 16;  // codes that one thread sorts at a time

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

// One pass of the sort: counts in blocks, sums over the blocks, then each block has places of its own to go
// to.
template <class Code>
void sort_by_digit(std::span<const CodeOfPrimitive<Code>> from, std::span<CodeOfPrimitive<Code>> to, int pass,
                   const Threads& threads) {
  using Counts = std::array<std::uint32_t, DIGITS>;
  std::vector<Counts> counts(chunk_count(from.size(), BLOCK));
  threads.for_each_chunk(from.size(), BLOCK, [&](Chunk block, std::size_t k) {
    Counts& own = counts[k];
    for (const auto& pair : from.subspan(block.begin, block.count())) ++own[digit_of(pair.code, pass)];
  });
  std::uint32_t sum = 0;
  for (std::uint32_t digit = 0; digit < DIGITS; ++digit) {
    for (Counts& of_block : counts) sum += std::exchange(of_block[digit], sum);
  }
  threads.for_each_chunk(from.size(), BLOCK, [&](Chunk block, std::size_t k) {
    Counts& next = counts[k];
    for (const auto& pair : from.subspan(block.begin, block.count())) {
      to[next[digit_of(pair.code, pass)]++] = pair;
    }
  });
}

template <class Code>
std::vector<std::uint32_t> radix_sorted_order(std::span<const std::uint64_t> codes, int code_bits,
                                              const Threads& threads) {
  using Pair = CodeOfPrimitive<Code>;
  const std::size_t count = codes.size();
  // Not vectors: these would be filled with zeros first, by one thread.
  auto from = std::make_unique_for_overwrite<Pair[]>(count);
  auto to = std::make_unique_for_overwrite<Pair[]>(count);
  threads.for_each_chunk(count, BLOCK, [&](Chunk block, std::size_t) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      from[i] = {static_cast<Code>(codes[i]), static_cast<std::uint32_t>(i)};
    }
  });
  const int passes = (code_bits + DIGIT_BITS - 1) / DIGIT_BITS;
  for (int pass = 0; pass < passes; ++pass) {
    sort_by_digit<Code>({from.get(), count}, {to.get(), count}, pass, threads);
    from.swap(to);
  }
  std::vector<std::uint32_t> order(count);
  threads.for_each_chunk(count, BLOCK, [&](Chunk block, std::size_t) {
    for (std::size_t i = block.begin; i < block.end; ++i) order[i] = from[i].primitive;
  });
  return order;
}

}  // namespace

MortonGrid::MortonGrid(const Aabb& scene, int bits_per_axis) : origin_(scene.box_min) {
  const vec3 extent = scene.box_max - scene.box_min;
  const float largest_extent = std::max({extent.x, extent.y, extent.z});
  if (largest_extent == 0.0f) return;
  cells_per_unit_ = std::ldexp(1.0f, bits_per_axis - 1 - std::ilogb(largest_extent));
}

std::uint64_t MortonGrid::code_of(const Aabb& box) const {
  const vec3 centre = (box.box_min + box.box_max) * 0.5f;
  const glm::uvec3 cell((centre - origin_) * cells_per_unit_);
  return spread_bits(cell.x) << 2 | spread_bits(cell.y) << 1 | spread_bits(cell.z);
}

std::vector<std::uint64_t> morton_codes(std::span<const Aabb> boxes, int bits_per_axis) {
  std::vector<std::uint64_t> codes;
  if (boxes.empty()) return codes;
  Aabb scene = boxes.front();
  for (const Aabb& box : boxes) scene = box_union(scene, box);
  const MortonGrid grid(scene, bits_per_axis);
  codes.reserve(boxes.size());
  for (const Aabb& box : boxes) codes.push_back(grid.code_of(box));
  return codes;
}

std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> codes, int code_bits) {
  return sorted_order(codes, code_bits, Threads(1));
}

std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> codes, int code_bits,
                                        const Threads& threads) {
  return code_bits <= 32 ? radix_sorted_order<std::uint32_t>(codes, code_bits, threads)
                         : radix_sorted_order<std::uint64_t>(codes, code_bits, threads);
}

}  // namespace coppice
