#include <algorithm>

#include "interface/sort.h"

namespace coppice::twins {

void sort_tile_counts(const SortPassArgs& args) {
  const uint tiles = (args.count + SORT_TILE - 1) / SORT_TILE;
  std::fill_n(&args.tile_status[0], std::size_t{tiles} * SORT_DIGITS, 0u);
  for (uint i = 0; i < args.count; ++i) {
    const uint word = args.keys_in[std::size_t{i} * args.key_words + args.pass / SORT_PASSES_PER_WORD];
    const uint digit = word >> (args.pass % SORT_PASSES_PER_WORD * SORT_DIGIT_BITS) & (SORT_DIGITS - 1);
    ++args.tile_status[std::size_t{i / SORT_TILE} * SORT_DIGITS + digit];
  }
}

}  // namespace coppice::twins
