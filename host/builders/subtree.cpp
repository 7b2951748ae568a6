#include "builders/subtree.h"

#include <bit>

namespace coppice {

bool must_halve(const Subtree& subtree) {
  // Halving n primitives takes ceil(log2 n) levels. With more levels than that to go another split is free:
  // it leaves both parts room for theirs.
  const auto levels = static_cast<std::uint32_t>(std::bit_width(subtree.count() - 1));
  return subtree.depth + levels >= SPLIT_HEIGHT_LIMIT;
}

}  // namespace coppice
