#include <algorithm>

#include "interface/sort.h"
#include "twins/device_count.h"

namespace coppice::twins {

void sort_tile_counts(const SortScatterArgs& args) {
  const uint digits = 1u << args.digit_bits;
  const uint count = counted(args.count_at, args.count);
  const uint tiles = (count + args.tile_keys - 1) / args.tile_keys;
  std::fill_n(&args.tile_digits[0], std::size_t{tiles} * digits, 0u);
  for (uint i = 0; i < count; ++i) {
    const uint word = args.keys_in[std::size_t{i} * args.key_words + args.digit_word];
    const uint digit = word >> args.digit_shift & (digits - 1);
    ++args.tile_digits[std::size_t{i / args.tile_keys} * digits + digit];
  }
}

}  // namespace coppice::twins
