#include <utility>

#include "interface/sort.h"

namespace coppice::twins {

void sort_tile_scan(const SortTileScanArgs& args) {
  const uint digits = 1u << args.digit_bits;
  uint place = 0;
  for (uint digit = 0; digit < digits; ++digit) {
    for (uint tile = 0; tile < args.tile_count; ++tile) {
      place += std::exchange(args.tile_digits[std::size_t{tile} * digits + digit], place);
    }
  }
}

}  // namespace coppice::twins
