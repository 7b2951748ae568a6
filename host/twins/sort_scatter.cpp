#include "interface/sort.h"

namespace coppice::twins {

void sort_scatter(const SortScatterArgs& args) {
  const uint digits = 1u << args.digit_bits;
  for (uint i = 0; i < args.count; ++i) {
    const std::size_t source = std::size_t{i} * args.key_words;
    const uint digit = args.keys_in[source + args.digit_word] >> args.digit_shift & (digits - 1);
    const uint place = args.tile_digits[std::size_t{i / args.tile_keys} * digits + digit]++;
    for (uint word = 0; word < args.key_words; ++word) {
      args.keys_out[std::size_t{place} * args.key_words + word] = args.keys_in[source + word];
    }
    if (args.values_in.value) args.values_out[place] = args.values_in[i];
  }
}

}  // namespace coppice::twins
