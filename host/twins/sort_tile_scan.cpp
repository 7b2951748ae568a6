#include <utility>

#include "interface/sort.h"
#include "twins/device_count.h"

namespace coppice::twins {

void sort_tile_scan(const SortTileScanArgs& args) {
  const uint digits = 1u << args.digit_bits;
  const uint tiles = (counted(args.count_at, args.count) + args.tile_keys - 1) / args.tile_keys;
  uint place = 0;
  for (uint digit = 0; digit < digits; ++digit) {
    for (uint tile = 0; tile < tiles; ++tile) {
      place += std::exchange(args.tile_digits[std::size_t{tile} * digits + digit], place);
    }
  }
}

}  // namespace coppice::twins
