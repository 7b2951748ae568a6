#include <utility>

#include "interface/sort.h"

namespace coppice::twins {

void sort_tile_scan(const SortTileScanArgs& args) {
  for (uint digit = 0; digit < SORT_DIGITS; ++digit) {
    uint sum = 0;
    for (uint tile = 0; tile < args.tile_count; ++tile) {
      uint& word = args.tile_status[std::size_t{tile} * SORT_DIGITS + digit];
      sum += std::exchange(word, sum);
    }
  }
}

}  // namespace coppice::twins
