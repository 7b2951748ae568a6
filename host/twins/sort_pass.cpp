#include <algorithm>
#include <array>

#include "interface/sort.h"
#include "twins/count_error.h"
#include "twins/lookback_words.h"

namespace coppice::twins {

void sort_pass(const SortPassArgs& args) {
  const uint shift = args.pass % SORT_PASSES_PER_WORD * SORT_DIGIT_BITS;
  std::array<uint, SORT_DIGITS> counts{};
  const uint count = counted(args.count_at, args.count);
  note_count(args.state[0], args.count_at, args.count);
  // All workgroups take one, those without keys too.
  args.ticket[0] += std::max((args.count + args.tile_keys - 1) / args.tile_keys, 1u);
  for (uint i = 0; i < count; ++i) {
    const std::size_t source = std::size_t{i} * args.key_words;
    const uint digit = args.keys_in[source + args.pass / SORT_PASSES_PER_WORD] >> shift & (SORT_DIGITS - 1);
    const uint place = args.digit_offsets[digit] + counts[digit]++;
    for (uint word = 0; word < args.key_words; ++word) {
      args.keys_out[std::size_t{place} * args.key_words + word] = args.keys_in[source + word];
    }
    if (args.values_in.value) args.values_out[place] = args.values_in[i];

    const bool ends_tile = (i + 1) % args.tile_keys == 0 || i + 1 == count;
    if (ends_tile) leave_inclusive_prefix(args.tile_status, i / args.tile_keys, counts);
  }
}

}  // namespace coppice::twins
