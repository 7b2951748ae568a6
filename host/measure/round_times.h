#pragma once

#include "measure/kernel_times.h"
#include "measure/table.h"

namespace coppice {

// One round of PLOC that had dispatches of its own, or all rounds of the finish together.
struct PlocRoundTime {
  std::uint32_t round, clusters, merged;
  bool pair_all;  // paired all clusters, whatever their distance
  bool finish;    // all rounds of ploc_finish
  double ms = 0;  // without lookback, sums and scan of the tiles included
};

// From a split of the build that left `counts`.
std::vector<PlocRoundTime> ploc_round_times(const KernelSplit& split, const RunCounts& counts);

Table table_of(const std::vector<PlocRoundTime>& rounds);

}  // namespace coppice
