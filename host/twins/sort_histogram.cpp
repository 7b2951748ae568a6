#include "interface/sort.h"
#include "twins/device_count.h"

namespace coppice::twins {

void sort_histogram(const SortHistogramArgs& args) {
  const std::size_t count = counted(args.count_at, args.count);
  for (std::size_t i = 0; i < count * args.key_words; ++i) {
    const std::size_t first_pass = i % args.key_words * SORT_PASSES_PER_WORD;
    for (uint pass = 0; pass < SORT_PASSES_PER_WORD; ++pass) {
      const uint digit = args.keys[i] >> (pass * SORT_DIGIT_BITS) & (SORT_DIGITS - 1);
      ++args.histogram[(first_pass + pass) * SORT_DIGITS + digit];
    }
  }
}

}  // namespace coppice::twins
