#include <algorithm>

#include "interface/sort.h"
#include "twins/count_error.h"

namespace coppice::twins {

namespace {

uint digit_of(const SortScatterArgs& args, uint i) {
  const uint word = args.keys_in[std::size_t{i} * args.key_words + args.digit_word];
  return word >> args.digit_shift & ((1u << args.digit_bits) - 1);
}

// Where the first key of each digit goes, if there is only one tile.
void place_digits(const SortScatterArgs& args, uint count) {
  const uint digits = 1u << args.digit_bits;
  std::fill_n(&args.tile_digits[0], digits, 0u);
  for (uint i = 0; i < count; ++i) {
    if (const uint digit = digit_of(args, i); digit + 1 < digits) ++args.tile_digits[digit + 1];
  }
  for (uint digit = 1; digit < digits; ++digit) args.tile_digits[digit] += args.tile_digits[digit - 1];
}

}  // namespace

void sort_scatter(const SortScatterArgs& args) {
  const uint count = counted(args.count_at, args.count);
  note_count(args.state[0], args.count_at, args.count);
  if (args.count <= args.tile_keys && count > 0) place_digits(args, count);
  for (uint i = 0; i < count; ++i) {
    const std::size_t source = std::size_t{i} * args.key_words;
    const std::size_t tile = i / args.tile_keys;
    const uint place = args.tile_digits[(tile << args.digit_bits) + digit_of(args, i)]++;
    for (uint word = 0; word < args.key_words; ++word) {
      args.keys_out[std::size_t{place} * args.key_words + word] = args.keys_in[source + word];
    }
    if (args.values_in.value) args.values_out[place] = args.values_in[i];
  }
}

}  // namespace coppice::twins
