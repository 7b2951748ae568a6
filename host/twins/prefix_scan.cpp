#include <algorithm>

#include "interface/scan.h"
#include "twins/count_error.h"
#include "twins/lookback_words.h"

namespace coppice::twins {

void prefix_scan(const PrefixScanArgs& args) {
  constexpr uint tile_words = SCAN_TILE * 4;
  const uint count = counted(args.count_at, args.word_count);
  note_count(args.state[0], args.count_at, args.word_count);
  // All workgroups take one, those without words too.
  if (args.lookback) args.ticket[0] += std::max((args.word_count + tile_words - 1) / tile_words, 1u);
  uint sum = 0, sum_before_tile = 0;
  std::array<uint, SCAN_SUMS> prefix{};
  for (uint i = 0; i < count; ++i) {
    const uint word = args.source[i / 4][i % 4];
    args.target[i / 4][i % 4] = sum;
    sum += word;
    const bool ends_tile = (i + 1) % tile_words == 0 || i + 1 == count;
    if (args.lookback && ends_tile) {
      prefix[0] += (sum - sum_before_tile) % 65536;
      prefix[1] += (sum - sum_before_tile) / 65536;
      sum_before_tile = sum;
      leave_inclusive_prefix(args.tile_status, i / tile_words, prefix);
    }
  }
}

}  // namespace coppice::twins
