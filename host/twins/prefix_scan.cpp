#include "interface/scan.h"
#include "twins/lookback_words.h"

namespace coppice::twins {

void prefix_scan(const PrefixScanArgs& args) {
  uint sum = 0, sum_before_tile = 0;
  std::array<uint, SCAN_SUMS> prefix{};
  for (uint i = 0; i < args.quad_count; ++i) {
    const uvec4 words = args.source[i];
    for (int k = 0; k < 4; ++k) {
      args.target[i][k] = sum;
      sum += words[k];
    }
    const bool ends_tile = (i + 1) % SCAN_TILE == 0 || i + 1 == args.quad_count;
    if (args.lookback && ends_tile) {
      prefix[0] += (sum - sum_before_tile) % 65536;
      prefix[1] += (sum - sum_before_tile) / 65536;
      sum_before_tile = sum;
      leave_inclusive_prefix(args.tile_status, i / SCAN_TILE, prefix);
      ++args.ticket[0];
    }
  }
}

}  // namespace coppice::twins
