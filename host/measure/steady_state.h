#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace coppice {

// What repeated runs took.
struct SteadyTime {
  std::vector<double> runs_ms;     // the runs that count, in order
  std::uint32_t warm_up_runs = 0;  // those before
  bool stable = false;             // the medians of the last two batches of the warm-up agree
};

// How long to warm up, and when to call it stable.
struct SteadyOptions {
  std::uint32_t runs = 9;                // that count
  std::uint32_t batch = 5;               // runs whose medians are compared
  double tolerance = 0.05;               // relative
  std::uint32_t most_warm_up_runs = 60;  // at least two batches
  double most_warm_up_ms = 4000;         // then the batch is ended, and no other one begun
};

// Of submits that are measured whole, builds, sorts and scans: the program ends after it, with one line.
inline constexpr double measured_limit_seconds = 120;

inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

struct Spread {
  double median, least, greatest;
};

inline Spread spread_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
  return {median, values.front(), values.back()};
}

// Calls `run`, which returns what it took in ms, until the median of a batch is that of the batch before, and
// then as often as counts. When the limit of the warm-up comes first it goes on all the same: not stable.
template <class Run>
SteadyTime measure_steady(const SteadyOptions& options, Run run) {
  SteadyTime time;
  double spent_ms = 0, last = 0;
  const auto batch = [&] {
    std::vector<double> batch_ms(options.batch);
    for (double& ms : batch_ms) spent_ms += ms = run();
    time.warm_up_runs += options.batch;
    return median_of(std::move(batch_ms));
  };
  last = batch();
  do {
    const double median = batch();
    time.stable = std::max(median, last) <= std::min(median, last) * (1 + options.tolerance);
    last = median;
  } while (!time.stable && time.warm_up_runs + options.batch <= options.most_warm_up_runs &&
           spent_ms < options.most_warm_up_ms);
  for (std::uint32_t i = 0; i < options.runs; ++i) time.runs_ms.push_back(run());
  return time;
}

}  // namespace coppice
