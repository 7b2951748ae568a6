#include <numeric>

#include "interface/sort.h"

namespace coppice::twins {

void sort_digit_scan(const SortDigitScanArgs& args) {
  for (uint pass = 0; pass < args.pass_count; ++pass) {
    uint* digits = &args.histogram[std::size_t{pass} * SORT_DIGITS];
    std::exclusive_scan(digits, digits + SORT_DIGITS, digits, 0u);
  }
}

}  // namespace coppice::twins
