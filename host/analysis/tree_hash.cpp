#include "analysis/tree_hash.h"

#include <array>
#include <bit>

namespace coppice {
namespace {

constexpr std::uint64_t OFFSET_BASIS = 14695981039346656037u;
constexpr std::uint64_t PRIME = 1099511628211u;

std::uint64_t hash_words(std::uint64_t hash, std::span<const std::uint32_t> words) {
  for (const std::uint32_t word : words) hash = (hash ^ word) * PRIME;
  return hash;
}

}  // namespace

std::uint64_t tree_hash(std::span<const Node> nodes) {
  std::uint64_t hash = OFFSET_BASIS;
  for (const Node& node : nodes) hash = hash_words(hash, std::bit_cast<std::array<std::uint32_t, 8>>(node));
  return hash;
}

std::uint64_t image_hash(std::span<const std::uint32_t> pixels) { return hash_words(OFFSET_BASIS, pixels); }

std::string hex16(std::uint64_t hash) {
  std::string digits(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
  return digits;
}

}  // namespace coppice
